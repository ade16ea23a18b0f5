//! Samples as they stream in: counted, checked in time, averaged into blocks so that memory stays
//! bounded.

use super::whole;
use crate::problem::{Fault, Place, Problem, Problems};
use crate::tables::{LEAST_ROWS, Listing, RESAMPLED_JITTER, ROUNDING_JITTER, Sampling};
use crate::tables::{note_swapped, resample, resampled, significant, too_few_rows};

/// How much of a record is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reduction {
    /// Most samples kept; even, at least 4.
    pub(super) most_samples: usize,
    /// Sampling frequency the record is reduced to, Hz; it is not reduced further than to
    /// `most_samples` without one.
    pub(super) reduce_to_hz: Option<f64>,
    /// Sampling frequency of a source without a time, Hz; none where it has one.
    pub(super) sampling_hz: Option<f64>,
    /// Whether a new record begins where the time goes back or has a gap.
    pub(super) split: bool,
}

/// A step of the time that is a gap, in usual steps.
const GAP: f64 = 10.0;
const SHORT_GAP: f64 = 1.5;
/// Equal steps after which a step of a few of them is one of lost rows.
const SURELY_EVEN: usize = 30;
/// Fewest samples of a part of a source.
const LEAST_PART: usize = 16;
/// Fewest samples whose uneven steps are those of a clock that rounds.
const LEAST_OF_CLOCK: usize = 16;
/// Most samples without a number in a row that are filled by a straight line.
const MOST_FILLED: usize = 10;
/// The last numbers of counters of 8, 16 and 32 bit, behind which they begin at 0.
const FULL_COUNTS: [f64; 3] = [255.0, 65_535.0, 4_294_967_295.0];
/// Least part of the steps of the time that a rounded clock makes shorter or longer than the others.
const LEAST_ROUNDED: f64 = 0.02;
/// The same where the longer step is twice the shorter: samples that were lost look alike.
const LEAST_ROUNDED_OF_TWICE: f64 = 0.2;
/// Largest part of a record that is filled by straight lines, where it is more than [`MOST_FILLED`] samples.
const MOST_FILLED_SHARE: f64 = 0.05;

/// Samples while they come in.
///
/// Blocks of `block` samples are averaged, time like the rest, so that a block stands at its middle.
/// When `most_samples` blocks are there, neighbours are averaged and `block` doubles: a mean is a mean
/// of means of equal blocks, so that the order of the halving leaves no trace.
pub(super) struct Gather {
    file: String,
    labels: Vec<String>,
    reduction: Reduction,
    block: usize,
    columns: Vec<Vec<f64>>,
    lines: Vec<usize>,
    sums: Vec<f64>,
    in_block: usize,
    block_line: usize,
    count: usize,
    time: TimeTrack,
    gaps: Gaps,
    /// The columns besides the time as `--columns` takes them.
    without_time: String,
    /// The records before this one in the source.
    before: Vec<Self>,
}

/// Samples without a number.
#[derive(Default)]
struct Gaps {
    /// Those since the last sample.
    open: usize,
    /// The last sample, the time of the source first.
    last: Vec<f64>,
    filled: usize,
    left_out: usize,
    /// Rows that stand twice.
    doubled: usize,
    /// Whether the record begins behind a gap.
    is_before: bool,
    /// The number that the source gave its last row.
    counted: Option<f64>,
    /// Blank lines between the first two rows, where rows stand for equal steps.
    usual_blank: Option<usize>,
    /// Whether a row was there already.
    is_begun: bool,
    /// Places where a table without a time is torn.
    torn: Listing,
}

/// Steps of the time as it comes in.
#[derive(Default)]
struct TimeTrack {
    /// The first different steps with their numbers: two, if a clock rounds.
    steps: Vec<(f64, usize)>,
    /// The line of the first stamp that is repeated, which a coarse clock does.
    repeated: Option<usize>,
    first_s: f64,
    last_s: f64,
    /// Shortest and longest step with the line behind it.
    shortest: Option<(f64, usize)>,
    longest: Option<(f64, usize)>,
    backward: Listing,
    /// Whether a step went back or was far from the usual one.
    faulty: bool,
    /// Whether a row that cannot be read was left out since the last sample.
    hole: bool,
    /// Whether one ever was.
    holes: bool,
}

/// Even times.
#[derive(Clone, Copy)]
struct Even {
    /// Time of the first block, s.
    first_s: f64,
    /// Step of the source, s.
    step_s: f64,
}

impl Even {
    /// The straight line of least squares through the times of blocks.
    fn through(times: &[f64], block: usize) -> Self {
        let n = times.len() as f64;
        let middle = 0.5 * (n - 1.0);
        let mean = times.iter().sum::<f64>() / n;
        let from_middle = |i: usize| i as f64 - middle;
        let (mut above, mut below) = (0.0, 0.0);
        for (i, time) in times.iter().enumerate() {
            above += from_middle(i) * (time - mean);
            below += from_middle(i) * from_middle(i);
        }
        let slope = above / below;
        Self { first_s: mean - slope * middle, step_s: slope / block as f64 }
    }
}

/// A record that has come in whole.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Gathered {
    /// Time, s, in equal steps.
    pub(super) time_s: Vec<f64>,
    /// The other columns.
    pub(super) columns: Vec<Vec<f64>>,
    /// Line of each sample in the source; empty without lines.
    pub(super) lines: Vec<usize>,
    /// Samples of the source.
    pub(super) count: usize,
    /// Samples of the source averaged into one.
    pub(super) block: usize,
    /// How the source is sampled.
    pub(super) sampling: Sampling,
    /// What a reader should know.
    pub(super) warnings: Vec<Problem>,
}

impl Gather {
    /// An empty record; the first of `labels` is the time, in s.
    pub(super) fn new(file: &str, labels: Vec<String>, reduction: Reduction) -> Self {
        let width = labels.len();
        Self {
            file: file.to_owned(),
            labels,
            reduction,
            block: 1,
            columns: vec![Vec::new(); width],
            lines: Vec::new(),
            sums: vec![0.0; width],
            in_block: 0,
            block_line: 0,
            count: 0,
            time: TimeTrack::default(),
            gaps: Gaps::default(),
            without_time: String::new(),
            before: Vec::new(),
        }
    }

    /// Begins a new record where a source is to be parted: the time goes back or has a gap.
    fn part(&mut self, time_s: f64) {
        let step = time_s - self.time.last_s;
        let usual = (self.time.last_s - self.time.first_s) / (self.count.max(2) - 1) as f64;
        // among equal steps a longer one is a gap already
        let most = if self.count > 2 && self.time.steps.len() == 1 { SHORT_GAP } else { GAP };
        let breaks = self.count > 0 && (step < 0.0 || self.count > 1 && step > most * usual);
        if self.reduction.split && breaks {
            self.begin_anew();
            self.gaps.is_before = step > 0.0;
        }
    }

    /// The same with the columns besides the time as `--columns` takes them.
    pub(super) fn without_time(self, without_time: String) -> Self {
        Self { without_time, ..self }
    }

    fn place(&self, line: usize) -> Place {
        if line > 0 { Place::at(&self.file, line, 1) } else { Place::file(&self.file) }
    }

    /// Tells of a row that cannot be read: the time steps across it say nothing.
    pub(super) fn leave_out(&mut self) {
        (self.time.hole, self.time.holes) = (true, true);
    }

    /// Tells of the blank lines before a row of a source without a time. Where they are others than between the first two
    /// rows, samples may have been lost: there the record is parted or refused.
    pub(super) fn blank_lines(&mut self, count: usize, line: usize, problems: &mut Problems) {
        if !std::mem::replace(&mut self.gaps.is_begun, true) {
            return;
        }
        let usual = *self.gaps.usual_blank.get_or_insert(count);
        if count == usual {
            return;
        }
        if self.reduction.split {
            self.begin_anew();
            self.gaps.is_begun = true;
            self.gaps.usual_blank = Some(usual);
            return;
        }
        let message = format!(
            "{count} blank lines or comments before this row, {usual} between the first two: in a table without a time none can tell whether samples were lost there; import with --split, which begins a run there, or delete these lines, or write NaN into those of lost samples"
        );
        let place = self.place(line);
        self.gaps.torn.push(problems, place, Fault::Other(message));
    }

    /// Tells of the number that a source without a time gives its next row, numbers that it skips are samples
    /// without a value. Where the numbers begin again, so does the record. `step`: what they rise by from row to row.
    pub(super) fn counted(
        &mut self,
        (number, step): (f64, f64),
        line: usize,
        problems: &mut Problems,
    ) {
        let Some(last) = self.gaps.counted else {
            self.gaps.counted = Some(number).filter(|number| number.is_finite());
            return;
        };
        let number = if number.is_finite() { number } else { last + step };
        self.gaps.counted = Some(number);
        let skipped = ((number - last) / step).round() - 1.0;
        let is_full = FULL_COUNTS.iter().any(|full| (last - full).abs() < 0.5);
        if skipped > 0.0 {
            self.gaps.open = self.gaps.open.saturating_add(whole(skipped.min(1e12)));
        } else if skipped < 0.0 && !(is_full && number.abs() < 0.5) {
            if self.reduction.split {
                return self.begin_anew();
            }
            let message = format!(
                "the numbers of the rows go from {last} to {number}: another record begins here, or rows stand twice; import with --split, which begins a run here, or leave their column out by - in its place: --columns -,command_V,displacement_um"
            );
            let place = self.place(line);
            self.gaps.torn.push(problems, place, Fault::Other(message));
        }
    }

    /// Takes a sample up that may lack numbers. Up to [`MOST_FILLED`] such samples between two others are filled by straight
    /// lines; more are a gap, where the record is parted or refused.
    pub(super) fn push_or_miss(&mut self, row: Vec<f64>, line: usize, problems: &mut Problems) {
        if row.iter().any(|value| !value.is_finite()) {
            self.gaps.open += 1;
            return;
        }
        // a clock that told every sample so far repeats none
        let is_told = self.reduction.sampling_hz.is_none() && self.time.repeated.is_none();
        if is_told && self.count >= SURELY_EVEN && row == self.gaps.last {
            self.gaps.doubled += 1;
            return;
        }
        let lost = self.rows_lost(row[0]);
        let open = std::mem::take(&mut self.gaps.open) + lost;
        let last = std::mem::take(&mut self.gaps.last);
        if last.is_empty() {
            self.gaps.left_out += open;
        } else if open > MOST_FILLED && self.reduction.split {
            self.gaps.left_out += open;
            self.begin_anew();
            self.gaps.is_before = true;
        } else if open > MOST_FILLED {
            let message = format!(
                "{open} samples before this line have no number or no row, more than the {MOST_FILLED} that are filled; import with --split, which parts the record there"
            );
            problems.push(self.place(line), Fault::Other(message));
            self.leave_out();
        } else {
            for k in 1..=open {
                let part = k as f64 / (open + 1) as f64;
                let between = last.iter().zip(&row).map(|(a, b)| a + part * (b - a));
                self.push(between, line, problems);
            }
            self.gaps.filled += open;
        }
        self.push(row.iter().copied(), line, problems);
        self.gaps.last = row;
    }

    /// Rows that a source with a time and equal steps leaves out before a time.
    fn rows_lost(&self, time_s: f64) -> usize {
        let is_timed = self.reduction.sampling_hz.is_none();
        let ([(step_s, _)], true, 0) = (&self.time.steps[..], is_timed, self.gaps.open) else {
            return 0;
        };
        let steps = (time_s - self.time.last_s) / step_s;
        let is_whole = (steps - steps.round()).abs() <= 0.02 * steps;
        let is_short = (1.5..MOST_FILLED as f64 + 1.5).contains(&steps);
        if self.count < SURELY_EVEN || self.time.hole || !is_whole || !is_short {
            return 0;
        }
        whole(steps.round() - 1.0)
    }

    /// Ends a record and begins the next of the same source.
    fn begin_anew(&mut self) {
        let without_time = self.without_time.clone();
        let fresh = Self::new(&self.file, self.labels.clone(), self.reduction);
        let gaps = Gaps { counted: self.gaps.counted, ..Gaps::default() };
        let fresh = Self { gaps, without_time, ..fresh };
        let mut ended = std::mem::replace(self, fresh);
        self.before = std::mem::take(&mut ended.before);
        self.before.push(ended);
    }

    /// Takes one sample up: the time, s, if the source has one, and the other columns. `line` is 0
    /// where there are none.
    pub(super) fn push(
        &mut self,
        row: impl IntoIterator<Item = f64>,
        line: usize,
        problems: &mut Problems,
    ) {
        let time_s = self.reduction.sampling_hz.map(|hz| 1.0 / hz * self.count as f64);
        let mut row = time_s.into_iter().chain(row);
        let Some(time_s) = row.next() else { return };
        self.part(time_s);
        self.track_time(time_s, line, problems);
        self.count += 1;
        if self.in_block == 0 {
            self.block_line = line;
        }
        for (sum, value) in self.sums.iter_mut().zip(std::iter::once(time_s).chain(row)) {
            *sum += value;
        }
        self.in_block += 1;
        if self.in_block < self.block {
            return;
        }
        let block = self.block as f64;
        for (column, sum) in self.columns.iter_mut().zip(&mut self.sums) {
            column.push(*sum / block);
            *sum = 0.0;
        }
        if self.block_line > 0 {
            self.lines.push(self.block_line);
        }
        self.in_block = 0;
        if self.columns[0].len() >= self.reduction.most_samples {
            self.average(2);
        }
    }

    fn track_time(&mut self, time_s: f64, line: usize, problems: &mut Problems) {
        let place = self.place(line);
        let track = &mut self.time;
        if self.count == 0 {
            track.first_s = time_s;
        } else if !track.hole {
            let step = time_s - track.last_s;
            if step < 0.0 {
                let fault = Fault::TimeNotIncreasing { time_s, before_s: track.last_s };
                track.backward.push(problems, place.field(&self.labels[0]), fault);
                track.faulty = true;
            } else if step <= 0.0 {
                track.repeated.get_or_insert(line);
            }
            let is_alike = |other: f64| (step - other).abs() <= 1e-3 * step.abs().max(other.abs());
            match track.steps.iter().position(|(other, _)| is_alike(*other)) {
                Some(known) => track.steps[known].1 += 1,
                None if track.steps.len() < 3 => track.steps.push((step, 1)),
                None => {}
            }
            if track.shortest.is_none_or(|(s, _)| step < s) {
                track.shortest = Some((step, line));
            }
            if track.longest.is_none_or(|(s, _)| step > s) {
                track.longest = Some((step, line));
            }
        }
        track.last_s = time_s;
        track.hole = false;
    }

    /// Averages each `factor` neighbours; those at the end that are fewer are left out.
    fn average(&mut self, factor: usize) {
        for column in &mut self.columns {
            let means = column.chunks_exact(factor).map(|c| c.iter().sum::<f64>() / factor as f64);
            *column = means.collect();
        }
        let samples = self.columns[0].len();
        self.lines = self.lines.iter().copied().step_by(factor).take(samples).collect();
        self.block *= factor;
    }

    /// The records, parts of too few samples left out; none if one cannot be used, which `problems` then say.
    pub(super) fn finish(mut self, problems: &mut Problems) -> Option<Vec<Gathered>> {
        let mut parts = std::mem::take(&mut self.before);
        parts.push(self);
        let all = parts.len();
        if all > 1 && parts.iter().any(|part| part.count >= LEAST_PART) {
            parts.retain(|part| part.count >= LEAST_PART);
        }
        let left_out = all - parts.len();
        let file = parts.first().map(|part| part.file.clone()).unwrap_or_default();
        let mut found = parts
            .into_iter()
            .map(|part| part.whole(problems))
            .collect::<Option<Vec<Gathered>>>()?;
        if let (1.., Some(first)) = (left_out, found.first_mut()) {
            let message =
                format!("{left_out} parts of less than {LEAST_PART} samples are left out");
            first.warnings.push(Problem::new(Place::file(file), Fault::Other(message)));
        }
        Some(found)
    }

    /// The one record; none if it cannot be used, which `problems` then say.
    fn whole(mut self, problems: &mut Problems) -> Option<Gathered> {
        std::mem::take(&mut self.time.backward).finish(problems);
        std::mem::take(&mut self.gaps.torn).finish(problems);
        let label = self.labels[0].clone();
        if self.count < LEAST_ROWS {
            problems.push(Place::file(&self.file), too_few_rows(self.count));
            return None;
        }
        let step_s = (self.time.last_s - self.time.first_s) / (self.count - 1) as f64;
        let rounded = self.rounded();
        let mut warnings = self.told();
        let sampling = if let Some((even, grain_s)) = &rounded {
            let step_s = even.step_s;
            let message = format!(
                "the time stamps differ by {} s, the steps of their clock; equal steps of {} s are taken",
                significant(*grain_s, 6),
                significant(step_s, 6)
            );
            warnings
                .push(Problem::new(Place::file(&self.file).field(&label), Fault::Other(message)));
            Sampling { step_s, jitter: 0.0 }
        } else {
            if let Some(line) = self.time.repeated {
                let message = format!(
                    "stamps repeat: the clock is too coarse to tell the steps between the samples; leave it out and give the rate: --columns {} --sampling-hz HZ",
                    self.without_time
                );
                problems.push(self.place(line).field(&label), Fault::Other(message));
                self.time.faulty = true;
            }
            Sampling { step_s, jitter: self.jitter(step_s, &label, problems) }
        };
        let filled = self.gaps.filled;
        if filled > MOST_FILLED && filled as f64 > MOST_FILLED_SHARE * self.count as f64 {
            let message = format!(
                "{filled} of {} samples have no number, more than {:.0} %; where a column has a lower rate than another one, import it from a file of its own",
                self.count,
                100.0 * MOST_FILLED_SHARE
            );
            problems.push(Place::file(&self.file), Fault::Other(message));
        }
        if !problems.is_empty() {
            if self.time.faulty {
                let others = self.labels.iter().map(String::as_str).zip(&self.columns).skip(1);
                note_swapped(&Place::file(&self.file).field(label), others, problems);
            }
            return None;
        }
        if let Some(wanted_hz) = self.reduction.reduce_to_hz {
            let rate_hz = 1.0 / (step_s * self.block as f64);
            // a rate a hair below a whole multiple is that multiple
            let factor = whole((rate_hz / wanted_hz * (1.0 + 1e-6)).floor().clamp(1.0, 1e9));
            if factor > 1 {
                self.average(factor);
            }
        }
        let left_out = self.count - self.block * self.columns[0].len();
        if left_out > 0 {
            let message = format!(
                "{left_out} samples at the end fill no block of {} and are left out",
                self.block
            );
            warnings.push(Problem::new(Place::file(&self.file), Fault::Other(message)));
        }
        let mut columns = self.columns;
        let mut time_s = columns.remove(0);
        if time_s.len() < LEAST_ROWS {
            problems.push(Place::file(&self.file), too_few_rows(time_s.len()));
            return None;
        }
        if sampling.jitter > ROUNDING_JITTER {
            resample(&mut time_s, &mut columns.iter_mut().collect::<Vec<_>>());
            warnings.push(resampled(&self.file, &label, sampling));
        }
        if let Some((even, _)) = rounded {
            for (i, time) in time_s.iter_mut().enumerate() {
                *time = even.first_s + even.step_s * self.block as f64 * i as f64;
            }
        }
        // the digits of the source's times differ by rounding: equal steps are written
        let (first, last) = (time_s[0], time_s[time_s.len() - 1]);
        let even = (last - first) / (time_s.len() - 1) as f64;
        for (i, time) in time_s.iter_mut().enumerate() {
            *time = first + even * i as f64;
        }
        let (lines, count, block) = (self.lines, self.count, self.block);
        Some(Gathered { time_s, columns, lines, count, block, sampling, warnings })
    }

    /// What was filled and left out.
    fn told(&self) -> Vec<Problem> {
        let &Gaps { open, filled, left_out, doubled, .. } = &self.gaps;
        let told = [
            (filled, "samples without a number are filled by straight lines"),
            (left_out + open, "samples without a number at an end are left out"),
            (doubled, "rows that repeat the one before, time and all, are left out"),
        ];
        let told = told.into_iter().filter(|(count, _)| *count > 0);
        let behind = "it begins behind a gap: a model knows nothing of the motion before and starts at rest; window_s of the run in dataset.ron leaves its first cycle out";
        let told = told.map(|(count, words)| format!("{count} {words}"));
        let told = told.chain(self.gaps.is_before.then(|| behind.to_owned()));
        told.map(|text| Problem::new(Place::file(&self.file), Fault::Other(text))).collect()
    }

    /// The even times behind stamps that a clock rounded, and the step of the clock, s.
    ///
    /// Equal steps that are rounded to a clock are two whole multiples of its step, one more than the other. Where the
    /// longer is twice the shorter and rare, samples may have been lost: that is no clock. The step is that of the straight line of least squares through the stamps.
    fn rounded(&self) -> Option<(Even, f64)> {
        let &[a, b] = &self.time.steps[..] else { return None };
        if self.count < LEAST_OF_CLOCK {
            return None;
        }
        let (short, long) = if a.0 < b.0 { (a, b) } else { (b, a) };
        let grain_s = long.0 - short.0;
        let multiple = short.0 / grain_s;
        let rarer = short.1.min(long.1) as f64;
        let is_twice = (multiple - 1.0).abs() < 0.01;
        let least = if is_twice { LEAST_ROUNDED_OF_TWICE } else { LEAST_ROUNDED };
        let is_clock = short.0 >= 0.0
            && (multiple - multiple.round()).abs() < 0.01
            && rarer >= least * (short.1 + long.1) as f64;
        let mut even = Even::through(&self.columns[0], self.block);
        // a clock that ticks every so many samples; over the record none can tell the step from that
        let tick_s = grain_s / (grain_s / even.step_s).round();
        let samples = self.count as f64;
        if short.0 <= 0.0 && (tick_s - even.step_s).abs() * samples <= 0.5 * grain_s {
            even.first_s -= 0.5 * (tick_s - even.step_s) * samples;
            even.step_s = tick_s;
        }
        let is_near = |(i, time): (usize, &f64)| {
            let line = even.first_s + even.step_s * self.block as f64 * i as f64;
            (time - line).abs() <= 1.01 * grain_s
        };
        let fits = is_clock && self.columns[0].iter().enumerate().all(is_near);
        fits.then_some((even, grain_s))
    }

    /// Largest deviation of a step from the usual one; a problem if it is no jitter.
    ///
    /// The usual step is the mean; where a gap spoils the mean, the median of the steps kept.
    fn jitter(&mut self, mean_s: f64, label: &str, problems: &mut Problems) -> f64 {
        let (Some(shortest), Some(longest)) = (self.time.shortest, self.time.longest) else {
            return 0.0;
        };
        let mut steps: Vec<f64> = self.columns[0].windows(2).map(|w| w[1] - w[0]).collect();
        steps.sort_by(f64::total_cmp);
        let median_s = steps.get(steps.len() / 2).map_or(mean_s, |s| s / self.block as f64);
        let torn = self.time.holes || longest.0 > 2.0 * median_s;
        let usual_s = if torn { median_s } else { mean_s };
        let deviation = |step: (f64, usize)| (step.0 - usual_s).abs() / usual_s;
        let worst = if deviation(shortest) > deviation(longest) { shortest } else { longest };
        let (step_s, line) = worst;
        // steps that go back are reported already
        if deviation(worst) > RESAMPLED_JITTER && shortest.0 > 0.0 {
            let place = self.place(line).field(label);
            let [step_s, usual_s] = [step_s, usual_s].map(|step| significant(step, 6));
            problems.push(place, Fault::TimeStepUneven { step_s, usual_s });
            self.time.faulty = true;
        }
        deviation(worst)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gather(reduction: Reduction, samples: usize, jitter: f64) -> Result<Gathered, Problems> {
        let labels = vec!["time_s".to_owned(), "u_V".to_owned()];
        let mut gather = Gather::new("r.csv", labels, reduction);
        let mut problems = Problems::default();
        for i in 0..samples {
            let time = i as f64 * 1e-3 + if i % 2 == 1 { jitter * 1e-3 } else { 0.0 };
            gather.push([time, 2.0 * time], i + 2, &mut problems);
        }
        let found = gather.finish(&mut problems).and_then(|mut parts| parts.pop());
        problems.into_result(found)
    }

    fn reduction(most_samples: usize, reduce_to_hz: Option<f64>) -> Reduction {
        Reduction { most_samples, reduce_to_hz, sampling_hz: None, split: false }
    }

    #[test]
    fn blocks_are_means_and_few() {
        let all = gather(reduction(1000, None), 999, 0.0).unwrap();
        assert_eq!((all.block, all.time_s.len(), all.warnings.len()), (1, 999, 0));
        let some = gather(reduction(100, None), 10_007, 0.0).unwrap();
        assert_eq!((some.count, some.block), (10_007, 128));
        assert_eq!(some.time_s.len(), 10_007 / 128);
        assert!(some.warnings[0].to_string().contains("23 samples at the end"));
        // the mean of 0..127 ms, and of twice that
        for (i, (t, u)) in some.time_s.iter().zip(&some.columns[0]).enumerate() {
            let middle = 1e-3 * (128.0 * i as f64 + 63.5);
            assert!((t - middle).abs() < 1e-12 && (u - 2.0 * middle).abs() < 1e-12, "{i}");
        }
        assert_eq!(some.lines[1], 2 + 128);
        let rate = gather(reduction(1000, Some(250.0)), 999, 0.0).unwrap();
        assert_eq!((rate.block, rate.time_s.len()), (4, 249));
    }

    #[test]
    fn jitter_is_rounded_resampled_or_refused() {
        assert!(gather(reduction(1000, None), 99, 0.005).unwrap().warnings.is_empty());
        let some = gather(reduction(1000, None), 99, 0.08).unwrap();
        assert!(
            some.warnings[0].to_string().contains("differ by up to 8 %"),
            "{:?}",
            some.warnings
        );
        for (t, u) in some.time_s.iter().zip(&some.columns[0]) {
            assert!((u - 2.0 * t).abs() < 1e-12, "a straight line stays one");
        }
        let text = gather(reduction(1000, None), 99, 0.4).unwrap_err().to_string();
        assert!(text.contains("expected uniform sampling"), "{text}");
    }

    /// A time that begins again, a gap, a stray sample between.
    #[test]
    fn a_source_is_parted_where_the_time_breaks() {
        let labels = vec!["time_s".to_owned(), "u_V".to_owned()];
        let part = |split: bool| {
            let reduction = Reduction { split, ..reduction(1000, None) };
            let mut gather = Gather::new("r.csv", labels.clone(), reduction);
            let mut problems = Problems::default();
            let starts = [(0.0, 100), (0.0, 50), (3.0, 60), (0.0, 2)];
            for (start, samples) in starts {
                for i in 0..samples {
                    let time = start + 1e-3 * f64::from(i);
                    gather.push([time, time], 1, &mut problems);
                }
            }
            let found = gather.finish(&mut problems);
            problems.into_result(found)
        };
        let found = part(true).unwrap();
        let counts: Vec<usize> = found.iter().map(|part| part.count).collect();
        assert_eq!(counts, [100, 50, 60]);
        assert!(found[0].warnings[0].to_string().contains("1 parts of less than 16 samples"));
        assert!((found[2].time_s[0] - 3.0).abs() < 1e-12);
        part(false).unwrap_err();
    }

    /// Ten million samples: what is kept stays small, and is right.
    #[test]
    fn ten_million_samples_stay_bounded() {
        let labels = vec!["time_s".to_owned(), "u_V".to_owned()];
        let mut gather = Gather::new("r.csv", labels, reduction(4096, None));
        let mut problems = Problems::default();
        let mut largest = 0;
        for i in 0..10_000_000_usize {
            gather.push([i as f64 * 1e-4, (i % 7) as f64], i + 1, &mut problems);
            largest = largest.max(gather.columns[0].capacity() + gather.lines.capacity());
        }
        assert!(largest <= 4 * 4096, "{largest} numbers kept");
        let found = gather.finish(&mut problems).unwrap().remove(0);
        assert_eq!((found.count, found.block), (10_000_000, 4096));
        assert!(found.columns[0].iter().all(|u| (u - 3.0).abs() < 4e-3), "means of 0 to 6");
    }

    #[test]
    fn one_sample_is_too_few() {
        let text = gather(reduction(1000, None), 1, 0.0).unwrap_err().to_string();
        assert!(text.contains("has 1 rows of numbers, expected at least 3"), "{text}");
    }
}
