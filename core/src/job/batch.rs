//! Many frames over workers into a data set.
//!
//! Workers take frames in order; each makes, encodes and stages its frame, and the calling thread
//! commits what they hand over, so that waiting for the disk holds up no worker. What is written
//! depends on neither the number of workers nor who made which frame. A frame that goes wrong is
//! written down and the rest goes on; a disk that goes wrong ends the run. Nothing here knows how a
//! frame is made.

use std::any::Any;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::{Duration, Instant};

use super::progress::{Meter, Progress};
use super::{FrameMaker, RenderedFrame};
use crate::export::{Dataset, ExportError, FailedFrame, Report, SkippedAsset, StagedFrame};
use crate::plan::StageTimes;

/// What a batch is to do.
#[derive(Clone, Debug)]
pub struct Order<'a> {
    /// Where the frames go.
    pub dataset: &'a Dataset,
    /// Which frames; not empty.
    pub frames: Range<u32>,
    /// How many threads make them.
    pub workers: NonZeroUsize,
    /// Set from outside to end the run after the frames in hand.
    pub stop: &'a AtomicBool,
}

/// How a batch went.
#[derive(Clone, Debug)]
pub struct Summary {
    /// What is written to `report.json`.
    pub report: Report,
    /// From the start until the index was written.
    pub wall: Duration,
    /// Threads that made frames.
    pub workers: usize,
    /// Time by stage, summed over the workers. With what they spent waiting it adds up to the wall
    /// time times the workers, unless a maker uses threads of its own.
    pub times: StageTimes,
    /// Time of the thread beside them that synced and named files and wrote the index.
    pub disk_times: StageTimes,
}

/// Why a batch ended early. Frames that were committed before stay.
#[derive(Debug, thiserror::Error)]
pub enum BatchError<E: std::error::Error> {
    /// No maker could be set up.
    #[error("cannot start to render: {0}")]
    Maker(E),
    /// The disk is at fault.
    #[error("{source} ({done} frames were written before; they are whole)")]
    Storage {
        /// What went wrong.
        source: ExportError,
        /// Frames in the data set.
        done: u64,
    },
}

/// What workers hand to the calling thread.
enum Message<E> {
    Made(u32, StagedFrame, Vec<SkippedAsset>),
    Failed(FailedFrame),
    Storage(ExportError),
    NoMaker(E),
}

/// Runs the frames of an order with one maker for each worker, and writes the index.
///
/// # Errors
/// When no maker can be set up or the disk is at fault. The index is written all the same if it can
/// be.
pub fn run<M, F>(
    order: &Order<'_>,
    new_maker: F,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Summary, BatchError<M::Error>>
where
    M: FrameMaker,
    M::Error: Send,
    F: Fn() -> Result<M, M::Error> + Sync,
{
    let start = Instant::now();
    let next = AtomicU64::new(u64::from(order.frames.start));
    let give_up = AtomicBool::new(false);
    let mut clerk = Clerk::new(order, start, progress);
    let (mut times, mut busy) = (StageTimes::default(), Duration::ZERO);
    let new_maker = &new_maker;
    std::thread::scope(|scope| {
        let (sender, receiver) = sync_channel(order.workers.get() * 2);
        let threads: Vec<_> = (0..order.workers.get())
            .map(|_| Worker { order, next: &next, give_up: &give_up, sender: sender.clone() })
            .map(|worker| scope.spawn(move || worker.run(new_maker)))
            .collect();
        drop(sender);
        clerk.serve(&receiver, &give_up);
        for thread in threads {
            // Frames are made behind catch_unwind, so that a panic here is one of our own.
            let (worker_times, worker_busy) =
                thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            times.merge(&worker_times);
            busy += worker_busy;
        }
    });
    clerk.finish();
    let wall = start.elapsed();
    let all = wall * u32::try_from(order.workers.get()).unwrap_or(u32::MAX);
    times.add("idle at start and end", all.saturating_sub(busy));
    clerk.close(wall, times)
}

/// A thread that makes frames.
struct Worker<'a, E> {
    order: &'a Order<'a>,
    next: &'a AtomicU64,
    give_up: &'a AtomicBool,
    sender: SyncSender<Message<E>>,
}

impl<E: std::error::Error> Worker<'_, E> {
    /// Time by stage, and their sum.
    fn run<M: FrameMaker<Error = E>>(
        self,
        new_maker: &impl Fn() -> Result<M, E>,
    ) -> (StageTimes, Duration) {
        let start = Instant::now();
        let mut times = StageTimes::default();
        let mut maker = None;
        while !self.order.stop.load(Ordering::Relaxed) && !self.give_up.load(Ordering::Relaxed) {
            let Some(frame) = self.take() else { break };
            let made = match &mut maker {
                Some(maker) => Ok(maker),
                None => times.measure("start up", new_maker).map(|new| maker.insert(new)),
            };
            let message = match made {
                Ok(maker) => self.frame(maker, frame, &mut times),
                Err(e) => Err(Message::NoMaker(e)),
            };
            let message = message.unwrap_or_else(|message| {
                // After a panic its buffers may hold anything.
                maker = None;
                message
            });
            // Fails only if the calling thread is gone, and then there is nothing left to do.
            if times.measure("wait for the disk", || self.sender.send(message)).is_err() {
                break;
            }
        }
        (times, start.elapsed())
    }

    fn take(&self) -> Option<u32> {
        let frame = self.next.fetch_add(1, Ordering::Relaxed);
        u32::try_from(frame).ok().filter(|f| *f < self.order.frames.end)
    }

    /// The message about a frame; an error if the maker must not be used again.
    fn frame<M: FrameMaker<Error = E>>(
        &self,
        maker: &mut M,
        frame: u32,
        times: &mut StageTimes,
    ) -> Result<Message<E>, Message<E>> {
        let failed = |reason| Message::Failed(FailedFrame { frame, reason });
        let start = Instant::now();
        let made = catch_unwind(AssertUnwindSafe(|| maker.make(frame)));
        let spent = start.elapsed();
        let made = match made {
            Ok(Ok(made)) => {
                times.merge(&made.times);
                times.add("rest of the frame", spent.saturating_sub(made.times.total()));
                made
            }
            Ok(Err(e)) => {
                times.add("failed frames", spent);
                return Ok(failed(chain(&e)));
            }
            Err(panic) => {
                times.add("failed frames", spent);
                return Err(failed(format!("the program is at fault: {}", panic_text(&*panic))));
            }
        };
        Ok(match self.stage(&made, times) {
            Ok(staged) => Message::Made(frame, staged, made.skipped),
            Err(e) if e.is_storage() => Message::Storage(e),
            Err(e) => failed(chain(&e)),
        })
    }

    fn stage(
        &self,
        made: &RenderedFrame,
        times: &mut StageTimes,
    ) -> Result<StagedFrame, ExportError> {
        let RenderedFrame { scene, picture, annotations, skipped, .. } = made;
        let encoded = times.measure("encode", || {
            self.order.dataset.encode(scene, picture.as_deref(), annotations, skipped)
        })?;
        times.measure("write", || encoded.stage())
    }
}

/// An error with what caused it, each said once.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let more = error.to_string();
        if !text.contains(&more) {
            text = format!("{text}: {more}");
        }
        cause = error.source();
    }
    text
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("it panicked")
}

/// The calling thread: commits frames, keeps the books, writes the index.
struct Clerk<'a, E> {
    order: &'a Order<'a>,
    start: Instant,
    progress: &'a mut dyn FnMut(&Progress),
    meter: Meter,
    report: Report,
    times: StageTimes,
    storage: Option<ExportError>,
    no_maker: Option<E>,
}

impl<'a, E: std::error::Error> Clerk<'a, E> {
    fn new(order: &'a Order<'a>, start: Instant, progress: &'a mut dyn FnMut(&Progress)) -> Self {
        Self {
            order,
            start,
            progress,
            meter: Meter::new(u32::try_from(order.frames.len()).unwrap_or(u32::MAX)),
            report: Report { asked: order.frames.clone(), ..Report::default() },
            times: StageTimes::default(),
            storage: None,
            no_maker: None,
        }
    }

    /// Takes messages until all workers are gone.
    fn serve(&mut self, messages: &Receiver<Message<E>>, give_up: &AtomicBool) {
        while let Ok(message) = self.times.measure("wait for frames", || messages.recv()) {
            match message {
                Message::Made(frame, staged, skipped) if self.storage.is_none() => {
                    match self.times.measure("sync and rename", || staged.commit()) {
                        Ok(()) => {
                            self.report.done.insert(frame);
                            self.report.skipped.extend(skipped);
                            self.tell(frame, true);
                        }
                        Err(e) => self.storage = Some(e),
                    }
                }
                // The disk is at fault, so that its files are dropped with it.
                Message::Made(..) => {}
                Message::Failed(failed) => {
                    let frame = failed.frame;
                    self.report.failed.push(failed);
                    self.tell(frame, false);
                }
                Message::Storage(e) => {
                    self.storage.get_or_insert(e);
                }
                Message::NoMaker(e) => {
                    self.no_maker.get_or_insert(e);
                }
            }
            if self.storage.is_some() || self.no_maker.is_some() {
                give_up.store(true, Ordering::Relaxed);
            }
        }
    }

    fn tell(&mut self, frame: u32, good: bool) {
        let progress = self.meter.finished(frame, good, self.start.elapsed());
        (self.progress)(&progress);
    }

    /// Writes the index over the frames that are there.
    fn finish(&mut self) {
        let tried = self.report.done.len() + self.report.failed.len() as u64;
        self.report.interrupted = tried < self.order.frames.len() as u64;
        self.report.failed.sort();
        let written = self.times.measure("index", || self.order.dataset.finish(&self.report));
        if let Err(e) = written {
            self.storage.get_or_insert(e);
        }
    }

    fn close(self, wall: Duration, times: StageTimes) -> Result<Summary, BatchError<E>> {
        let Self { order, report, times: disk_times, storage, no_maker, .. } = self;
        match (storage, no_maker) {
            (Some(source), _) => Err(BatchError::Storage { source, done: report.done.len() }),
            (None, Some(e)) => Err(BatchError::Maker(e)),
            (None, None) => {
                Ok(Summary { report, wall, workers: order.workers.get(), times, disk_times })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::{Existing, PictureFormat, sample};
    use crate::plan::{Outputs, PassPlan, SceneFacts};
    use std::collections::BTreeMap;
    use std::fs;
    use std::path::Path;
    use std::sync::Mutex;

    /// Fails at multiples of 7, panics at multiples of 11 (but 0), else takes an uneven while.
    struct Maker {
        spoil: bool,
        /// Frames made since it was new.
        made: Vec<u32>,
    }

    #[derive(Debug, thiserror::Error)]
    #[error("frame {0} will not come out")]
    struct Refused(u32);

    impl FrameMaker for Maker {
        type Error = Refused;

        fn make(&mut self, frame: u32) -> Result<RenderedFrame, Refused> {
            assert!(!self.spoil || frame % 11 != 3, "number {frame} is cursed");
            assert!(
                self.made.last().is_none_or(|last| last % 11 != 3 || !self.spoil),
                "used after a panic"
            );
            self.made.push(frame);
            if self.spoil && frame % 7 == 5 {
                return Err(Refused(frame));
            }
            let mut times = StageTimes::default();
            times.measure("pretend", || {
                std::thread::sleep(Duration::from_millis(u64::from(frame * 5 % 7)))
            });
            Ok(RenderedFrame {
                scene: sample::scene(frame),
                picture: Some(sample::picture(frame)),
                annotations: sample::labels(frame, (frame % 5) as u16),
                skipped: Vec::new(),
                plan: PassPlan::new(&Outputs::new(), SceneFacts::default()),
                times,
            })
        }
    }

    fn dataset(root: &Path) -> Dataset {
        let info = sample::info(sample::all_outputs(), PictureFormat::DEFAULT);
        Dataset::create(root, info, Existing::Refuse).unwrap()
    }

    fn order<'a>(dataset: &'a Dataset, workers: usize, stop: &'a AtomicBool) -> Order<'a> {
        Order { dataset, frames: 2..40, workers: NonZeroUsize::new(workers).unwrap(), stop }
    }

    fn run_with(root: &Path, workers: usize, spoil: bool) -> Summary {
        let (dataset, stop) = (dataset(root), AtomicBool::new(false));
        let new_maker = || Ok(Maker { spoil, made: Vec::new() });
        run(&order(&dataset, workers, &stop), new_maker, &mut |_| {}).unwrap()
    }

    fn tree(root: &Path) -> BTreeMap<String, Vec<u8>> {
        let (mut found, mut folders) = (BTreeMap::new(), vec![root.to_owned()]);
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let name = path.strip_prefix(root).unwrap().to_str().unwrap().to_owned();
                    found.insert(name, fs::read(&path).unwrap());
                }
            }
        }
        found
    }

    #[test]
    fn the_number_of_workers_leaves_no_trace() {
        let trees = [1, 2, 5].map(|workers| {
            let dir = tempfile::tempdir().unwrap();
            let summary = run_with(dir.path(), workers, false);
            assert!(summary.report.is_complete() && summary.report.failed.is_empty());
            tree(dir.path())
        });
        assert_eq!(trees[0].keys().filter(|name| name.starts_with("images/")).count(), 38);
        assert!(!trees[0].keys().any(|name| name.starts_with(".figurant")));
        assert!(trees[0] == trees[1] && trees[0] == trees[2]);
    }

    #[test]
    fn failures_and_panics_are_written_down_and_the_rest_goes_on() {
        let bad = |f: &u32| f % 11 == 3 || f % 7 == 5;
        let trees = [1, 3].map(|workers| {
            let dir = tempfile::tempdir().unwrap();
            let summary = run_with(dir.path(), workers, true);
            let report = &summary.report;
            assert!(!report.interrupted);
            assert!(report.done.iter().eq((2..40).filter(|f| !bad(f))));
            assert!(report.failed.iter().map(|f| f.frame).eq((2..40).filter(bad)));
            let reason = |frame| &report.failed.iter().find(|f| f.frame == frame).unwrap().reason;
            assert_eq!(reason(12), "frame 12 will not come out");
            assert_eq!(reason(14), "the program is at fault: number 14 is cursed");
            tree(dir.path())
        });
        assert!(trees[0] == trees[1]);
    }

    #[test]
    fn a_stop_finishes_the_frames_in_hand_and_writes_the_index() {
        let dir = tempfile::tempdir().unwrap();
        let (dataset, stop) = (dataset(dir.path()), AtomicBool::new(false));
        let new_maker = || Ok::<_, Refused>(Maker { spoil: false, made: Vec::new() });
        let mut told = Vec::new();
        let mut progress = |p: &Progress| {
            told.push(p.frame);
            stop.store(p.done >= 6, Ordering::Relaxed);
        };
        let summary = run(&order(&dataset, 2, &stop), new_maker, &mut progress).unwrap();
        let done: Vec<u32> = summary.report.done.iter().collect();
        assert!(summary.report.interrupted && (6..20).contains(&done.len()), "{done:?}");
        told.sort_unstable();
        assert_eq!(told, done);
        let index: serde_json::Value =
            serde_json::from_slice(&fs::read(dataset.layout().annotations()).unwrap()).unwrap();
        let listed =
            index["images"].as_array().unwrap().iter().map(|i| i["id"].as_u64().unwrap() as u32);
        assert!(listed.eq(done.iter().copied()));
        let whole = |name: &String| !name.ends_with(".tmp");
        assert!(tree(dir.path()).keys().all(whole));
    }

    #[test]
    fn a_disk_at_fault_ends_the_run_and_keeps_what_is_there() {
        let dir = tempfile::tempdir().unwrap();
        let (dataset, stop) = (dataset(dir.path()), AtomicBool::new(false));
        let new_maker = || Ok::<_, Refused>(Maker { spoil: false, made: Vec::new() });
        // The folder of the scenes vanishes behind our back.
        let mut progress = |p: &Progress| {
            if p.done == 4 {
                fs::rename(dir.path().join("scenes"), dir.path().join("gone")).unwrap();
            }
        };
        let error = run(&order(&dataset, 2, &stop), new_maker, &mut progress).unwrap_err();
        let BatchError::Storage { done, .. } = &error else { panic!("{error}") };
        assert!((4..12).contains(done), "{done}");
        assert!(error.to_string().contains("scenes"), "{error}");
        let index: serde_json::Value =
            serde_json::from_slice(&fs::read(dataset.layout().annotations()).unwrap()).unwrap();
        assert_eq!(index["images"].as_array().unwrap().len() as u64, *done);
    }

    #[test]
    fn a_maker_that_cannot_start_is_an_error() {
        let dir = tempfile::tempdir().unwrap();
        let (dataset, stop) = (dataset(dir.path()), AtomicBool::new(false));
        let new_maker = || Err::<Maker, _>(Refused(0));
        let error = run(&order(&dataset, 2, &stop), new_maker, &mut |_| {}).unwrap_err();
        assert!(matches!(error, BatchError::Maker(_)), "{error}");
    }

    #[test]
    fn frames_are_handed_out_in_order_and_makers_are_kept() {
        static MADE: Mutex<Vec<Vec<u32>>> = Mutex::new(Vec::new());
        struct Recorder(Maker);
        impl FrameMaker for Recorder {
            type Error = Refused;
            fn make(&mut self, frame: u32) -> Result<RenderedFrame, Refused> {
                self.0.make(frame)
            }
        }
        impl Drop for Recorder {
            fn drop(&mut self) {
                MADE.lock().unwrap().push(std::mem::take(&mut self.0.made));
            }
        }
        let dir = tempfile::tempdir().unwrap();
        let (dataset, stop) = (dataset(dir.path()), AtomicBool::new(false));
        let new_maker = || Ok(Recorder(Maker { spoil: false, made: Vec::new() }));
        run(&order(&dataset, 3, &stop), new_maker, &mut |_| {}).unwrap();
        let made = MADE.lock().unwrap();
        assert!(made.len() <= 3);
        assert!(made.iter().all(|frames| frames.is_sorted()));
        let mut all: Vec<u32> = made.concat();
        all.sort_unstable();
        assert!(all.into_iter().eq(2..40));
    }

    #[test]
    fn the_stages_add_up_to_the_time_of_the_workers() {
        let dir = tempfile::tempdir().unwrap();
        let summary = run_with(dir.path(), 3, false);
        let sum = summary.times.total().as_secs_f64();
        let expected = summary.wall.as_secs_f64() * 3.0;
        assert!((sum / expected - 1.0).abs() < 0.1, "{sum} s of {expected} s");
        let disk = summary.disk_times.total().as_secs_f64();
        assert!((disk / summary.wall.as_secs_f64() - 1.0).abs() < 0.1, "{disk} s");
    }
}
