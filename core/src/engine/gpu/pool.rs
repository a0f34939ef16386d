//! What stays on the device from frame to frame: meshes or texels, each uploaded once.
//!
//! One buffer holds them all. An item is known by the address of its shared value; a weak
//! reference keeps that address from being used again. When there is no room the buffer grows, up
//! to what the adapter can bind, and then what was not used longest makes way.

use std::collections::BTreeMap;
use std::sync::{Arc, Weak};

use super::device::Device;
use crate::engine::EngineError;

/// Words of a new buffer.
const FIRST_WORDS: u64 = 1 << 20;

struct Item<T: ?Sized> {
    /// Keeps the address.
    held: Weak<T>,
    first: u64,
    last_used: u64,
}

/// Items of one kind in one buffer.
pub struct Pool<T: ?Sized> {
    what: &'static str,
    buffer: Option<wgpu::Buffer>,
    words: u64,
    items: BTreeMap<usize, Item<T>>,
    /// First word and length of what is taken.
    taken: BTreeMap<u64, u64>,
    frame: u64,
    /// Memory for what is uploaded next.
    scratch: Vec<u32>,
}

impl<T: ?Sized> Pool<T> {
    /// An empty pool; `what` names its items in errors.
    pub const fn new(what: &'static str) -> Self {
        Self {
            what,
            buffer: None,
            words: 0,
            items: BTreeMap::new(),
            taken: BTreeMap::new(),
            frame: 0,
            scratch: Vec::new(),
        }
    }

    /// The buffer; present once a frame has begun.
    pub const fn buffer(&self) -> Option<&wgpu::Buffer> {
        self.buffer.as_ref()
    }

    /// Starts a frame that uses these items: what is there already is kept for it.
    pub fn begin<'a>(&mut self, device: &Device, used: impl Iterator<Item = &'a Arc<T>>)
    where
        T: 'a,
    {
        self.frame += 1;
        for item in used {
            if let Some(known) = self.items.get_mut(&address(item)) {
                known.last_used = self.frame;
            }
        }
        if self.buffer.is_none() {
            self.words = FIRST_WORDS.min(device.largest_buffer() / 4);
            self.buffer = Some(new_buffer(device, self.what, self.words));
        }
    }

    /// First word of an item; uploads what `fill` hands back, which may be the memory that it is
    /// given, if it is not there.
    pub fn place(
        &mut self,
        device: &Device,
        item: &Arc<T>,
        words: u64,
        fill: impl for<'a> FnOnce(&'a T, &'a mut Vec<u32>) -> &'a [u32],
    ) -> Result<u32, EngineError> {
        let key = address(item);
        if let Some(known) = self.items.get_mut(&key) {
            known.last_used = self.frame;
            return Ok(known.first as u32);
        }
        let first = self.room(device, words)?;
        let content = fill(item, &mut self.scratch);
        if let Some(buffer) = &self.buffer {
            device.queue.write_buffer(buffer, first * 4, bytemuck::cast_slice(content));
        }
        self.taken.insert(first, words);
        let held = Arc::downgrade(item);
        self.items.insert(key, Item { held, first, last_used: self.frame });
        Ok(first as u32)
    }

    /// The first word of a free stretch.
    fn room(&mut self, device: &Device, words: u64) -> Result<u64, EngineError> {
        let limit = device.largest_buffer() / 4;
        loop {
            if let Some(first) = self.gap(words) {
                return Ok(first);
            }
            if self.evict(|item| item.held.strong_count() == 0) {
                continue;
            }
            if self.words < limit {
                self.grow(device, (self.words * 2).max(self.words + words).min(limit));
                continue;
            }
            let (frame, oldest) = (self.frame, self.items.values().map(|i| i.last_used).min());
            if oldest.is_none_or(|oldest| oldest == frame)
                || !self.evict(|item| Some(item.last_used) == oldest)
            {
                return Err(EngineError::TooLarge {
                    what: self.what,
                    got: (self.taken.values().sum::<u64>() + words) * 4,
                    limit: limit * 4,
                });
            }
        }
    }

    /// The first gap of a length.
    fn gap(&self, words: u64) -> Option<u64> {
        let mut end = 0;
        for (&first, &length) in &self.taken {
            if first - end >= words {
                return Some(end);
            }
            end = first + length;
        }
        (self.words - end >= words).then_some(end)
    }

    /// Forgets all items, those of this frame too: what is placed from now on stands side by side.
    pub fn forget(&mut self) {
        self.items.clear();
        self.taken.clear();
    }

    /// Forgets items; whether there were any.
    fn evict(&mut self, unwanted: impl Fn(&Item<T>) -> bool) -> bool {
        let before = self.items.len();
        let (frame, taken) = (self.frame, &mut self.taken);
        self.items.retain(|_, item| {
            let goes = item.last_used < frame && unwanted(item);
            if goes {
                taken.remove(&item.first);
            }
            !goes
        });
        self.items.len() < before
    }

    fn grow(&mut self, device: &Device, words: u64) {
        let larger = new_buffer(device, self.what, words);
        if let Some(old) = &self.buffer {
            let mut encoder = device.device.create_command_encoder(&Default::default());
            encoder.copy_buffer_to_buffer(old, 0, &larger, 0, self.words * 4);
            device.queue.submit([encoder.finish()]);
        }
        self.buffer = Some(larger);
        self.words = words;
    }
}

fn address<T: ?Sized>(item: &Arc<T>) -> usize {
    Arc::as_ptr(item).addr()
}

fn new_buffer(device: &Device, label: &str, words: u64) -> wgpu::Buffer {
    device.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: words * 4,
        usage: wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    })
}
