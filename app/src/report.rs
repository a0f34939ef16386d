//! Progress and the closing summary, as a bar, as lines or as JSON.

use std::path::Path;
use std::time::Duration;

use clap::ValueEnum;
use figurant_core::job::batch::Summary;
use figurant_core::job::progress::Progress;
use figurant_core::plan::StageTimes;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Map, Value, json};

use crate::Console;

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Style {
    /// A bar on a terminal, else a line now and then.
    Auto,
    /// A bar.
    Bar,
    /// One JSON object a line: each frame, then the summary.
    Json,
    /// Nothing but errors.
    None,
}

/// Time between lines where there is no terminal.
const PAUSE: Duration = Duration::from_secs(5);

enum Show {
    Bar(ProgressBar),
    /// With the time of the last line.
    Lines(Duration),
    Json,
    Nothing,
}

/// Tells how far an export is.
pub struct Reporter<'a, 'b> {
    show: Show,
    console: &'a mut Console<'b>,
}

impl<'a, 'b> Reporter<'a, 'b> {
    /// A reporter for so many frames.
    pub fn new(style: Style, frames: u64, console: &'a mut Console<'b>) -> Self {
        let show = match style {
            Style::Auto if console.is_terminal() => Show::Bar(bar(frames)),
            Style::Auto => Show::Lines(Duration::ZERO),
            Style::Bar => Show::Bar(bar(frames)),
            Style::Json => Show::Json,
            Style::None => Show::Nothing,
        };
        Self { show, console }
    }

    /// A frame was finished.
    pub fn update(&mut self, p: &Progress) {
        match &mut self.show {
            Show::Bar(bar) => {
                bar.set_message(pace(p));
                bar.set_position(u64::from(p.done + p.failed));
            }
            Show::Lines(last) if p.elapsed.saturating_sub(*last) >= PAUSE => {
                *last = p.elapsed;
                self.console.note(&format!(
                    "{} of {} frames, {}",
                    p.done + p.failed,
                    p.total,
                    pace(p)
                ));
            }
            Show::Json => self.console.note(&frame_json(p).to_string()),
            Show::Lines(_) | Show::Nothing => {}
        }
    }

    /// Takes the bar away before an error is reported.
    pub fn clear(&self) {
        if let Show::Bar(bar) = &self.show {
            bar.finish_and_clear();
        }
    }

    /// The run is over.
    pub fn close(self, summary: &Summary, out: &Path) {
        self.clear();
        match self.show {
            Show::Json => self.console.note(&summary_json(summary, out).to_string()),
            Show::Nothing => {}
            Show::Bar(_) | Show::Lines(_) => self.console.note(&summary_text(summary, out)),
        }
    }
}

fn bar(frames: u64) -> ProgressBar {
    let template = "{bar:32} {pos}/{len} frames, {msg}";
    let style =
        ProgressStyle::with_template(template).expect("the template is a fixed text that is right");
    let bar = ProgressBar::with_draw_target(Some(frames), ProgressDrawTarget::stderr());
    bar.set_style(style);
    bar
}

/// "12.5 frames/s, 1 min 20 s left, 2 failed"
fn pace(p: &Progress) -> String {
    let mut text = format!("{:.1} frames/s", p.frames_per_s);
    if let Some(left) = p.left {
        text += &format!(", {} left", duration(left));
    }
    if p.failed > 0 {
        text += &format!(", {} failed", p.failed);
    }
    text
}

/// In the two largest units that matter.
fn duration(time: Duration) -> String {
    let s = time.as_secs();
    match s {
        0..60 => format!("{s} s"),
        60..3600 => format!("{} min {} s", s / 60, s % 60),
        _ => format!("{} h {} min", s / 3600, s % 3600 / 60),
    }
}

fn frame_json(p: &Progress) -> Value {
    json!({
        "event": "frame",
        "frame": p.frame,
        "done": p.done,
        "failed": p.failed,
        "total": p.total,
        "elapsed_s": p.elapsed.as_secs_f64(),
        "frames_per_s": p.frames_per_s,
        "left_s": p.left.map(|t| t.as_secs_f64()),
    })
}

/// Milliseconds that one worker spent on one frame.
fn per_frame_ms(time: Duration, summary: &Summary) -> f64 {
    let tried = summary.report.done.len() + summary.report.failed.len() as u64;
    time.as_secs_f64() * 1e3 / (tried.max(1) as f64)
}

fn stages_json(times: &StageTimes, summary: &Summary) -> Value {
    let entry =
        |(stage, time): (&str, Duration)| (stage.to_owned(), json!(per_frame_ms(time, summary)));
    Value::Object(times.iter().map(entry).collect::<Map<_, _>>())
}

fn summary_json(summary: &Summary, out: &Path) -> Value {
    let report = &summary.report;
    json!({
        "event": "summary",
        "out": out.display().to_string(),
        "done": report.done.len(),
        "failed": report.failed,
        "skipped_assets": report.skipped,
        "interrupted": report.interrupted,
        "wall_s": summary.wall.as_secs_f64(),
        "workers": summary.workers,
        "worker_ms_per_frame": stages_json(&summary.times, summary),
        "disk_ms_per_frame": stages_json(&summary.disk_times, summary),
    })
}

fn summary_text(summary: &Summary, out: &Path) -> String {
    let report = &summary.report;
    let (wall_s, done) = (summary.wall.as_secs_f64(), report.done.len());
    let workers = summary.workers;
    let mut text = format!("{:<22}{:>9}{:>9}\n", "stage", "ms/frame", "share");
    let all = summary.times.total().as_secs_f64().max(f64::MIN_POSITIVE);
    for (stage, time) in summary.times.iter() {
        let share = time.as_secs_f64() / all * 100.0;
        text += &format!("{stage:<22}{:>9.2}{share:>7.1} %\n", per_frame_ms(time, summary));
    }
    for (stage, time) in summary.disk_times.iter() {
        let aside = "beside";
        text += &format!("{stage:<22}{:>9.2}{aside:>9}\n", per_frame_ms(time, summary));
    }
    text += &format!(
        "{done} frames in {wall_s:.2} s ({:.1} frames/s, {workers} {}) -> {}",
        done as f64 / wall_s.max(f64::MIN_POSITIVE),
        if workers == 1 { "worker" } else { "workers" },
        out.display()
    );
    const SHOWN: usize = 5;
    for failed in report.failed.iter().take(SHOWN) {
        text += &format!("\nframe {} failed: {}", failed.frame, failed.reason);
    }
    if report.failed.len() > SHOWN {
        text += &format!("\nand {} more", report.failed.len() - SHOWN);
    }
    if !report.failed.is_empty() {
        text += &format!(
            "\nall {} failed frames are listed in {}",
            report.failed.len(),
            out.join("report.json").display()
        );
    }
    for skipped in report.skipped.iter().take(SHOWN) {
        text += &format!("\nskipped {}: {}", skipped.id, skipped.reason);
    }
    if report.skipped.len() > SHOWN {
        text += &format!(
            "\nall {} skipped pictures are listed in {}",
            report.skipped.len(),
            out.join("report.json").display()
        );
    }
    if report.interrupted {
        let missing = report.asked.len() as u64 - done - report.failed.len() as u64;
        text += &format!(
            "\ninterrupted: {missing} frames were not begun; what is written is whole and indexed"
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use figurant_core::export::{FailedFrame, Report, SkippedAsset};

    #[test]
    fn durations_show_two_units() {
        let of = |s| duration(Duration::from_secs(s));
        assert_eq!([of(0), of(59), of(60), of(3599)], ["0 s", "59 s", "1 min 0 s", "59 min 59 s"]);
        assert_eq!(of(7260), "2 h 1 min");
    }

    #[test]
    fn the_summary_counts_and_names_what_failed() {
        let failed = |frame| FailedFrame { frame, reason: "no people".to_owned() };
        let report = Report {
            asked: 0..20,
            done: (0..10).collect(),
            failed: (10..17).map(failed).collect(),
            skipped: [SkippedAsset { id: "a.png".to_owned(), reason: "cut".to_owned() }].into(),
            interrupted: true,
        };
        let mut times = StageTimes::default();
        times.add("encode", Duration::from_millis(170));
        let (wall, disk_times) = (Duration::from_secs(2), StageTimes::default());
        let summary = Summary { report, wall, workers: 2, times, disk_times };
        let text = summary_text(&summary, Path::new("out"));
        for part in [
            "10 frames in 2.00 s (5.0 frames/s, 2 workers) -> out",
            "frame 10 failed: no people",
            "and 2 more",
            "all 7 failed frames",
            "skipped a.png: cut",
            "3 frames were not begun",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        assert!(!text.contains("frame 15 failed"));
        let json = summary_json(&summary, Path::new("out"));
        assert_eq!(json["worker_ms_per_frame"]["encode"], 10.0);
    }
}
