//! Which points to measure next: those that tell the explanations left apart.

use super::floor::Floor;
use super::predicted::Tables;
use super::table::PointTable;
use crate::discovery::{Finding, Found, SURELY, Separation, needed_between, separations};
use crate::{Candidate, GapError};
use rayon::prelude::*;

/// Most points advised together.
const MOST_POINTS: usize = 6;

/// Points to measure next, and what they would settle.
#[derive(Debug, Clone, PartialEq)]
pub struct NextPoints {
    /// The points by number in the table, the one that tells most first. A measured one is to be repeated.
    pub points: Vec<usize>,
    /// Explanations that the data leave open, by number of the suspect, the best first.
    pub open: Vec<usize>,
    /// Share of the pairs of a truth and another explanation that the points would tell apart, 0 to 1.
    pub told_apart: f64,
    /// Smallest distance between two explanations there over what is asked for a sure name.
    pub least_distance: f64,
}

/// How far a set of points tells explanations apart: share of the pairs, smallest ratio to what is asked.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
struct Told {
    share: f64,
    least: f64,
}

impl Told {
    /// Of separations; `forms` are the errors of form of the rivals.
    fn of(found: &Separation, drop: f64, forms: &[f64]) -> Self {
        let count = found.energy.len();
        let pairs =
            (0..count).flat_map(|a| (0..count).filter(move |b| *b != a).map(move |b| (a, b)));
        let ratios: Vec<f64> = pairs
            .map(|(a, b)| {
                let asked = SURELY * needed_between(drop + found.energy[a], [forms[a], forms[b]]);
                found.distance[(a, b)] / asked
            })
            .collect();
        let told = ratios.iter().filter(|ratio| **ratio > 1.0).count();
        Self {
            share: told as f64 / ratios.len().max(1) as f64,
            least: ratios.iter().copied().fold(f64::INFINITY, f64::min),
        }
    }

    /// Whether it tells more than another: more pairs, of as many by a wider distance.
    fn beats(self, other: Self) -> bool {
        self.partial_cmp(&other) == Some(std::cmp::Ordering::Greater)
    }
}

/// The points that tell the explanations left apart; not measured ones first, measured ones only where there are none.
pub(super) fn next_points(
    table: &PointTable,
    floor: &Floor,
    candidates: &[Candidate],
    finding: &Finding,
) -> Result<Option<NextPoints>, GapError> {
    let open = finding.causes.iter().max_by_key(|found| found.rivals.len());
    let Some(open) = open.filter(|found| found.rivals.len() > 1) else { return Ok(None) };
    let all = 0..table.points.len();
    let possible: Vec<usize> = all.clone().filter(|&p| !table.points[p].is_measured()).collect();
    let mut left: Vec<usize> = if possible.is_empty() { all.collect() } else { possible };
    let mut chosen: Vec<usize> = Vec::new();
    let mut best: Option<Told> = None;
    while chosen.len() < MOST_POINTS && !left.is_empty() {
        let tried: Vec<Told> = left
            .par_iter()
            .map(|&p| told(table, floor, candidates, open, &[&chosen[..], &[p]].concat()))
            .collect::<Result<_, _>>()?;
        let mut place = 0;
        for k in 1..tried.len() {
            if tried[k].beats(tried[place]) {
                place = k;
            }
        }
        if best.is_some_and(|before| !tried[place].beats(before)) {
            break;
        }
        best = Some(tried[place]);
        chosen.push(left.remove(place));
        if tried[place].share >= 1.0 {
            break;
        }
    }
    Ok(best.map(|told| NextPoints {
        points: chosen,
        open: open.rivals.iter().map(|rival| rival.candidate).collect(),
        told_apart: told.share,
        least_distance: told.least,
    }))
}

/// How far the points given, all channels measured at each, tell the rivals of a cause apart.
fn told(
    table: &PointTable,
    floor: &Floor,
    candidates: &[Candidate],
    open: &Found,
    points: &[usize],
) -> Result<Told, GapError> {
    let channels: Vec<usize> = (0..table.channels.len()).collect();
    let rows = points.iter().map(|&p| (p, channels.clone())).collect();
    let tables = Tables { table, rows, sigma: floor.sigma.clone() };
    let (traces, _) = floor.traces(&tables);
    let found = separations(&tables, &traces, candidates, &open.rivals)?;
    let forms: Vec<f64> =
        open.rivals.iter().map(|rival| candidates[rival.candidate].form_error).collect();
    Ok(Told::of(&found, open.output_drop, &forms))
}
