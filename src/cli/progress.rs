//! A progress bar, for whoever waits longer than half a second at a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

pub(super) struct Progress {
    bar: ProgressBar,
    started: Instant,
    wanted: bool,
}

impl Progress {
    pub(super) fn new(total: u64, quiet: bool) -> Progress {
        let style =
            ProgressStyle::with_template("{bar:40} {percent} % {eta} left").expect("a fixed template");
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden()).with_style(style);
        Progress { bar, started: Instant::now(), wanted: !quiet && std::io::stderr().is_terminal() }
    }

    pub(super) fn advance(&mut self, by: u64) {
        if self.wanted && self.started.elapsed() > Duration::from_millis(500) {
            self.wanted = false;
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.inc(by);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
