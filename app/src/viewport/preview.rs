//! The preview: pictures are made by a thread of its own, and the window never waits for one.
//!
//! Only the latest wish counts: one that is replaced before its turn is never rendered.

use std::num::NonZeroUsize;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use figurant_core::engine::gpu::{GpuContext, ShaderFolder};

use super::worker::{Renderer, Request, Shown, Worker};
use crate::road::LoadError;
use crate::studio::Loaded;

/// What the thread has to say.
pub enum Answer {
    /// A config was loaded, or not.
    Opened(Result<Loaded, LoadError>),
    /// A picture is ready.
    Shown(Box<Shown>),
    /// A picture cannot be made, and why.
    Failed(String),
}

/// What the thread is to do next.
#[derive(Default)]
struct Inbox {
    open: Option<Option<PathBuf>>,
    show: Option<Request>,
    closed: bool,
}

/// What both sides see.
#[derive(Default)]
struct Shared {
    inbox: Mutex<Inbox>,
    filled: Condvar,
}

/// Wakes the window.
pub type Wake = Box<dyn Fn() + Send>;

/// A thread that renders.
pub struct Preview {
    shared: Arc<Shared>,
    answers: Receiver<Answer>,
    thread: Option<JoinHandle<()>>,
    asked: Option<Request>,
    busy: bool,
}

impl Preview {
    /// Starts the thread. `wake` is called after each answer.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(
        context: Option<GpuContext>,
        threads: NonZeroUsize,
        wake: Wake,
    ) -> std::io::Result<Self> {
        let shared = Arc::<Shared>::default();
        let (sender, answers) = channel();
        let seen = Arc::clone(&shared);
        let shaders = context.as_ref().and_then(|c| c.shaders.clone()).map(Watch::new);
        let thread = std::thread::Builder::new().name("preview".to_owned()).spawn(move || {
            serve(&seen, Worker::new(context, threads), shaders, &sender, &wake);
        })?;
        Ok(Self { shared, answers, thread: Some(thread), asked: None, busy: false })
    }

    /// Asks for a config, or for the one that the program starts with.
    pub fn open(&mut self, path: Option<PathBuf>) {
        self.busy = true;
        self.fill(|inbox| inbox.open = Some(path));
    }

    /// Asks for a picture, unless it was asked for already. Wishes before it are dropped.
    pub fn ask(&mut self, request: Request) {
        if self.asked.as_ref() == Some(&request) {
            return;
        }
        self.busy = true;
        self.asked = Some(request.clone());
        self.fill(|inbox| inbox.show = Some(request));
    }

    /// Has the same picture made again when it is asked for again.
    pub fn forget(&mut self) {
        self.asked = None;
    }

    /// The next answer, if there is one.
    pub fn poll(&mut self) -> Option<Answer> {
        let answer = self.answers.try_recv().ok()?;
        self.busy = match &answer {
            Answer::Shown(shown) => self.asked.as_ref() != Some(&shown.request),
            _ => false,
        };
        Some(answer)
    }

    /// Whether an answer is still to come.
    #[must_use]
    pub const fn is_busy(&self) -> bool {
        self.busy
    }

    fn fill(&self, change: impl FnOnce(&mut Inbox)) {
        change(&mut self.shared.inbox.lock().unwrap_or_else(PoisonError::into_inner));
        self.shared.filled.notify_one();
    }
}

impl Drop for Preview {
    /// Waits for the frame in hand, so that nothing is rendered on a device that is gone.
    fn drop(&mut self) {
        self.fill(|inbox| inbox.closed = true);
        if let Some(thread) = self.thread.take() {
            // What it panicked with was told when it happened.
            drop(thread.join());
        }
    }
}

/// What to do next, once there is something; nothing once the window is closed.
enum Next {
    Open(Option<PathBuf>),
    Show(Request),
}

/// How often the folder of shaders is looked at while there is nothing to do.
const LOOK: Duration = Duration::from_millis(250);

/// Notices that the picture which is shown was made by other shaders than there are now.
struct Watch {
    folder: ShaderFolder,
    generation: u64,
    shown: Option<Request>,
}

impl Watch {
    fn new(folder: ShaderFolder) -> Self {
        Self { folder, generation: 0, shown: None }
    }

    /// Remembers what is about to be shown.
    fn note(&mut self, request: &Request) {
        self.generation = self.folder.generation();
        self.shown = Some(request.clone()).filter(|r| r.renderer == Renderer::Graphics);
    }

    /// What is to be shown again.
    fn stale(&self) -> Option<Request> {
        let shown = self.shown.as_ref()?;
        (self.folder.generation() != self.generation).then(|| shown.clone())
    }
}

fn next(shared: &Shared, shaders: Option<&Watch>) -> Option<Next> {
    let mut inbox = shared.inbox.lock().unwrap_or_else(PoisonError::into_inner);
    loop {
        if inbox.closed {
            return None;
        }
        if let Some(path) = inbox.open.take() {
            return Some(Next::Open(path));
        }
        if let Some(request) = inbox.show.take() {
            return Some(Next::Show(request));
        }
        let Some(watch) = shaders else {
            inbox = shared.filled.wait(inbox).unwrap_or_else(PoisonError::into_inner);
            continue;
        };
        let waited = shared.filled.wait_timeout(inbox, LOOK);
        let (filled, timeout) = waited.unwrap_or_else(PoisonError::into_inner);
        inbox = filled;
        if timeout.timed_out()
            && let Some(request) = watch.stale()
        {
            return Some(Next::Show(request));
        }
    }
}

fn serve(
    shared: &Shared,
    mut worker: Worker,
    mut shaders: Option<Watch>,
    answers: &Sender<Answer>,
    wake: &Wake,
) {
    while let Some(next) = next(shared, shaders.as_ref()) {
        let answer = match next {
            Next::Open(path) => Answer::Opened(
                guarded(|| Worker::open(path.as_deref()))
                    .unwrap_or_else(|text| Err(LoadError::Unreadable(text))),
            ),
            Next::Show(request) => {
                let renderer = request.renderer;
                if let Some(watch) = &mut shaders {
                    watch.note(&request);
                }
                match guarded(|| worker.show(request)) {
                    Ok(Ok(shown)) => Answer::Shown(Box::new(shown)),
                    Ok(Err(e)) => Answer::Failed(e.to_string()),
                    Err(text) => {
                        worker.forget(renderer);
                        Answer::Failed(text)
                    }
                }
            }
        };
        // Fails only if the window is gone, and then there is nothing left to do.
        if answers.send(answer).is_err() {
            return;
        }
        wake();
    }
}

/// Runs a function; a text about its panic if it did.
fn guarded<T>(f: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(f)).map_err(|panic| {
        let text = panic.downcast_ref::<&str>().copied();
        let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
        format!("the program is at fault: {}", text.unwrap_or("it panicked"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use figurant_core::plan::Output;

    #[test]
    fn what_other_shaders_made_is_shown_again() {
        let dir = tempfile::tempdir().unwrap();
        let from = concat!(env!("CARGO_MANIFEST_DIR"), "/../shaders/scan.wgsl");
        let (text, file) = (std::fs::read_to_string(from).unwrap(), dir.path().join("scan.wgsl"));
        std::fs::write(&file, &text).unwrap();
        let mut watch = Watch::new(ShaderFolder::new(dir.path().to_owned(), |_| {}));
        assert!(watch.stale().is_none(), "nothing is shown yet");
        let config = Worker::open(None).unwrap();
        let outputs = [Output::Rgb].into();
        let (size, renderer) = ([16, 16], Renderer::Graphics);
        let shown = Request { config, frame: 0, seed: 0, size, viewpoint: None, outputs, renderer };
        watch.note(&shown);
        assert!(watch.stale().is_none());
        std::fs::write(&file, format!("{text}fn wrong( {{")).unwrap();
        assert!(watch.stale().is_none(), "a broken file changes nothing");
        std::fs::write(&file, format!("{text}// Another.\n")).unwrap();
        assert!(watch.stale().is_some_and(|request| request == shown));
        watch.note(&shown);
        assert!(watch.stale().is_none());
        // The native engine has no shaders.
        watch.note(&Request { renderer: Renderer::Native, ..shown });
        std::fs::write(&file, &text).unwrap();
        assert!(watch.stale().is_none());
    }
}
