//! Progress bars on the terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Whether warnings and progress are kept to itself.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Keeps warnings and progress off standard error from now on, or no longer.
pub fn set_quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

/// Whether warnings and progress are kept off standard error.
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Shows how far a run has come; hidden where standard error is no terminal.
#[derive(Debug, Clone)]
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar of `steps` steps.
    pub fn new(steps: usize) -> Self {
        if is_quiet() {
            return Self::hidden();
        }
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::stderr());
        // one step has no share and no end that could be told
        let template = if steps > 1 {
            "{msg}  {bar:24} {percent} %  {elapsed} gone, about {eta} left"
        } else {
            "{msg}  {spinner} {elapsed}"
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar }
    }

    /// No bar at all.
    pub fn hidden() -> Self {
        Self { bar: ProgressBar::hidden() }
    }

    /// Does a work of one step, and says so.
    pub fn during<T>(what: impl Into<String>, work: impl FnOnce() -> T) -> T {
        let progress = Self::new(1);
        progress.doing(what);
        let done = work();
        progress.finish();
        done
    }

    /// Says what is being done.
    pub fn doing(&self, what: impl Into<String>) {
        self.bar.set_message(what.into());
    }

    /// Says what begins, with so many steps done.
    pub fn begin(&self, done: usize, what: &str) {
        self.bar.set_position(done as u64);
        self.doing(what.to_owned());
    }

    /// One step is done.
    pub fn step(&self) {
        self.bar.inc(1);
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
