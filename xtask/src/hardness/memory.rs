//! Memory of one process over many cases.

use std::path::Path;
use std::time::Duration;

use super::place::Place;
use crate::{XtaskError, files};

/// Growth that is none: share and MB. An allocator keeps some of what it was given.
const SHARE: f64 = 0.1;
const SLACK_MB: f64 = 2.0;

/// Memory over the cases of a sweep.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Memory {
    /// Cases of the sweep.
    pub cases: usize,
    /// Mean resident memory seen in each tenth of the cases, MB; none where a tenth was over before it was looked at. The mean and
    /// not the largest: two large cases that meet on two threads are no growth.
    pub tenths_mb: Vec<Option<f64>>,
    /// Largest resident memory of the process, MB.
    pub peak_mb: f64,
}

impl Memory {
    /// Growth from the second tenth, when all is set up, to the last one, MB: that of the line nearest to them. None of
    /// fewer than two.
    pub fn growth_mb(&self) -> Option<f64> {
        let seen = self.tenths_mb.iter().enumerate().skip(1);
        let seen: Vec<(f64, f64)> = seen.filter_map(|(i, mb)| Some((i as f64, (*mb)?))).collect();
        let count = seen.len() as f64;
        let mean = seen.iter().map(|(i, _)| i).sum::<f64>() / count;
        let products = seen.iter().map(|(i, mb)| (i - mean) * mb).sum::<f64>();
        let squares = seen.iter().map(|(i, _)| (i - mean).powi(2)).sum::<f64>();
        let span = seen.last()?.0 - seen.first()?.0;
        (span > 0.0).then(|| span * products / squares)
    }

    /// Whether it does not grow with the cases.
    pub fn is_flat(&self) -> bool {
        let first = self.tenths_mb.iter().skip(1).flatten().next();
        let bound = first.map(|first| SHARE * first + SLACK_MB);
        self.growth_mb().zip(bound).is_some_and(|(growth, bound)| growth <= bound)
    }
}

impl std::fmt::Display for Memory {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let tenths = self.tenths_mb.iter();
        let shown: Vec<String> =
            tenths.map(|mb| mb.map_or("-".to_owned(), |mb| format!("{mb:.1}"))).collect();
        write!(
            f,
            "{} cases, mean resident MB by tenths of them: {}; at most {:.1}; growth {}",
            self.cases,
            shown.join(", "),
            self.peak_mb,
            self.growth_mb().map_or("unknown".to_owned(), |mb| format!("{mb:+.1} MB"))
        )
    }
}

/// The figure of a field of `/proc/PID/status` in MB.
fn field_mb(status: &str, field: &str) -> Option<f64> {
    let line = status.lines().find_map(|line| line.strip_prefix(field)?.strip_prefix(':'))?;
    line.split_whitespace().next()?.parse::<f64>().ok().map(|kb| kb / 1024.0)
}

/// Looks at the memory of a process while it computes the cases of a sweep.
pub(super) struct Watch {
    /// Results that were there before it began.
    before: usize,
    /// How often each tenth was looked at.
    looks: [f64; 10],
    pub(super) memory: Memory,
}

impl Watch {
    /// A watch over a sweep of which some results are there.
    pub(super) fn new(cases: usize, before: usize) -> Self {
        let memory = Memory { cases: cases - before, tenths_mb: vec![None; 10], peak_mb: 0.0 };
        Self { before, looks: [0.0; 10], memory }
    }

    /// Looks at a process while so many results are there.
    pub(super) fn look(&mut self, process: u32, there: usize) {
        let text = files::read(Path::new(&format!("/proc/{process}/status"))).unwrap_or_default();
        let memory = &mut self.memory;
        if let Some(mb) = field_mb(&text, "VmRSS") {
            let done = there.saturating_sub(self.before);
            let tenth = (10 * done / memory.cases.max(1)).min(9);
            let looks = &mut self.looks[tenth];
            *looks += 1.0;
            let mean = memory.tenths_mb[tenth].unwrap_or_default();
            memory.tenths_mb[tenth] = Some(mean + (mb - mean) / *looks);
        }
        memory.peak_mb = field_mb(&text, "VmHWM").unwrap_or_default().max(memory.peak_mb);
    }
}

/// Runs a sweep of small cases on one thread and looks at the memory of the process.
///
/// # Errors
/// [`XtaskError`] if the program cannot be run, or the sweep fails.
pub fn measure(program: &Path, cases: usize) -> Result<Memory, XtaskError> {
    let place = Place::new(program)?;
    place.write(
        "sweep.ron",
        &format!("(base: \"case.ron\", axes: [(field: \"rotor.gj\", from: 0.005, to: 0.007, count: {cases})])"),
    )?;
    let mut child = place.spawn(&["sweep", "run", "sweep.ron", "--out", "out"])?;
    let mut watch = Watch::new(cases, 0);
    let failed = |source| XtaskError::Start { program: "hhc sweep run".to_owned(), source };
    let ended = loop {
        if let Some(ended) = child.try_wait().map_err(failed)? {
            break ended;
        }
        watch.look(child.id(), results(&place));
        std::thread::sleep(Duration::from_millis(50));
    };
    if !ended.success() {
        let said = format!("ended with {ended}");
        return Err(XtaskError::Refused { program: "hhc sweep run".to_owned(), said });
    }
    Ok(watch.memory)
}

/// Results that are there.
pub(super) fn results(place: &Place) -> usize {
    let folders = files::in_folder(&place.path().join("out/results")).unwrap_or_default();
    folders.iter().map(|folder| files::in_folder(folder).map_or(0, |inside| inside.len())).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leak_is_told_from_a_flat_memory() {
        let of = |tenths: &[f64]| Memory {
            tenths_mb: tenths.iter().map(|mb| Some(*mb)).collect(),
            ..Memory::default()
        };
        assert!(of(&[5.0, 20.0, 21.0, 20.5]).is_flat());
        // what grows in the first tenth is set up, what grows behind it is a leak
        assert!(!of(&[5.0, 20.0, 23.0, 26.0]).is_flat());
        // one large case in between is none
        assert!(of(&[5.0, 20.0, 21.0, 40.0, 21.0, 20.0]).is_flat());
        let leak = of(&[5.0, 20.0, 22.0, 24.0, 26.0]).growth_mb();
        assert!(leak.is_some_and(|mb| (mb - 6.0).abs() < 1e-12), "{leak:?}");
        assert!(!Memory::default().is_flat(), "nothing seen is no proof");
        assert_eq!(field_mb("Name: a\nVmHWM:\t  2048 kB\n", "VmHWM"), Some(2.0));
    }
}
