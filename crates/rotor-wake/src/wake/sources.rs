//! The vortex segments of all blades at one instant, and how each depends on the circulation.

use super::settings::{
    FarField, FarTrailers, FreeWakeSettings, NearWakeMotion, ReleasePoint, ShedVorticity,
};
use crate::SegmentSet;
use crate::vector::{Vec3, add, norm, scale, sub};
use crate::{CirculationMap, WakeRotor};

/// Vatistas's (Lamb's) constant of core growth.
const ALPHA: f64 = 1.256_43;

/// Speed of a section along its chord, tip speed, below which its sheet does not leave it where the free stream slows it or
/// turns it round: it lies within some chords after the ages of a sheet. No more than the advance ratio.
const SLOW: f64 = 0.2;

/// Strength of a segment: a sum of at most four circulations `(index in the map, factor)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Terms([(usize, f64); 4]);

impl Terms {
    fn pair(a: (usize, f64), b: (usize, f64)) -> Self {
        Self([a, b, (0, 0.0), (0, 0.0)])
    }

    /// The terms that count.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.0.iter().copied().filter(|(_, factor)| *factor != 0.0)
    }

    fn strength(&self, circulation: &[f64]) -> f64 {
        self.iter().map(|(index, factor)| factor * circulation[index]).sum()
    }
}

/// Which circulation each rolled-up filament takes up at every azimuth.
///
/// A filament that collects what the nodes from `a` up to before `b` trail has the strength
/// `Gamma_(a-1) - Gamma_(b-1)`: the sums telescope.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RollUp {
    /// Spanwise nodes that release the filaments.
    pub(crate) nodes: Vec<usize>,
    /// `[filament][azimuth]`: panels counted from 1 (0: none), the first with sign +, the second -.
    panels: Vec<Vec<[usize; 2]>>,
}

impl RollUp {
    /// Nodes that release filaments.
    pub(crate) fn release_nodes(far: &FarTrailers, rotor: &WakeRotor) -> Vec<usize> {
        let tip = rotor.panels();
        let mut nodes = match far {
            FarTrailers::Tip => vec![tip],
            FarTrailers::TipAndRoot => vec![0, tip],
            FarTrailers::Stations(stations) => {
                let inner = stations.iter().map(|r| rotor.inner_node_near(*r));
                inner.chain([0, tip]).collect()
            }
        };
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    pub(crate) fn new(far: &FarTrailers, rotor: &WakeRotor, circulation: &CirculationMap) -> Self {
        let nodes = Self::release_nodes(far, rotor);
        let tip = rotor.panels();
        let peaks = circulation.outboard_peaks();
        let panels = (0..nodes.len())
            .map(|f| {
                let share = |peak: usize| -> [usize; 2] {
                    if nodes[f] == tip {
                        return [peak + 1, 0];
                    }
                    // borders halfway to the neighbours; nothing outboard of the peak
                    let border = |other: usize| (nodes[f] + other).div_ceil(2);
                    let from = if f == 0 { 0 } else { border(nodes[f - 1]) };
                    let to = if f + 2 < nodes.len() { border(nodes[f + 1]) } else { peak + 1 };
                    [from.min(peak + 1), to.min(peak + 1)]
                };
                peaks.iter().map(|&peak| share(peak)).collect()
            })
            .collect();
        Self { nodes, panels }
    }

    /// Where each filament is released at every azimuth, `[filament][azimuth]`, unit `R`.
    pub(crate) fn release_stations(
        &self,
        point: ReleasePoint,
        rotor: &WakeRotor,
        circulation: &CirculationMap,
    ) -> Vec<Vec<f64>> {
        let of = |f: usize, row: usize| self.release_station(f, row, point, rotor, circulation);
        (0..self.nodes.len())
            .map(|f| (0..circulation.azimuths()).map(|i| of(f, i)).collect())
            .collect()
    }

    /// Where filament `f` is released by the circulation of a row, unit `R`.
    pub(crate) fn release_station(
        &self,
        f: usize,
        row: usize,
        point: ReleasePoint,
        rotor: &WakeRotor,
        circulation: &CirculationMap,
    ) -> f64 {
        let own = rotor.nodes()[self.nodes[f]];
        match point {
            ReleasePoint::Station => own,
            ReleasePoint::Centroid => self.centroid(f, row, rotor, circulation).unwrap_or(own),
        }
    }

    /// Centroid of what filament `f` collects at an azimuth, within the nodes that trail it; none if they trail
    /// nothing.
    fn centroid(
        &self,
        f: usize,
        azimuth: usize,
        rotor: &WakeRotor,
        circulation: &CirculationMap,
    ) -> Option<f64> {
        let [from, to] = self.panels[f][azimuth];
        let to = if self.nodes[f] == rotor.panels() { rotor.panels() + 1 } else { to };
        let gamma = circulation.row(azimuth);
        let inboard = |n: usize| n.checked_sub(1).map_or(0.0, |s| gamma[s]);
        let outboard = |n: usize| gamma.get(n).copied().unwrap_or(0.0);
        let (mut strength, mut size, mut moment) = (0.0, 0.0, 0.0);
        for n in from..to {
            let trailed: f64 = inboard(n) - outboard(n);
            strength += trailed;
            size += trailed.abs();
            moment += trailed * rotor.nodes()[n];
        }
        // where both senses are trailed, their sum may have its centroid far off
        (strength.abs() > 0.1 * size)
            .then(|| (moment / strength).clamp(rotor.nodes()[from], rotor.nodes()[to - 1]))
    }

    /// Terms of filament `f` between two release azimuths.
    fn terms(&self, f: usize, releases: [usize; 2], panels: usize) -> Terms {
        let mut terms = [(0, 0.0); 4];
        for (pair, &release) in terms.chunks_exact_mut(2).zip(&releases) {
            for ((term, panel), sign) in
                pair.iter_mut().zip(self.panels[f][release]).zip([0.5, -0.5])
            {
                if panel > 0 {
                    *term = (release * panels + panel - 1, sign);
                }
            }
        }
        Terms(terms)
    }
}

/// The circulations that a blade has had: a ring of rows of the map, of which one is of the present. The rows are a multiple
/// of the azimuth steps, and the present one lies in them as the blade does in its revolution.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Past {
    /// First row of the ring.
    pub(crate) first: usize,
    pub(crate) rows: usize,
    /// Row of the present, counted from the first.
    pub(crate) now: usize,
}

impl Past {
    /// Row of an age, counted from the first.
    fn back(self, age: usize) -> usize {
        (self.now + self.rows - age % self.rows) % self.rows
    }

    /// Row of an age, steps.
    pub(crate) fn row(self, age: usize) -> usize {
        self.first + self.back(age)
    }
}

/// One blade with its wake at one instant.
#[derive(Debug, Clone)]
pub(crate) struct BladeView<'a> {
    /// What it has carried.
    pub(crate) past: Past,
    /// Nodes of the lifting line.
    pub(crate) line: &'a [Vec3],
    /// Where the trailers leave the blade.
    pub(crate) edge: &'a [Vec3],
    /// Near-wake trailer of every spanwise node, from its release.
    pub(crate) near: Vec<&'a [Vec3]>,
    /// Rolled-up filaments, from their release.
    pub(crate) far: Vec<&'a [Vec3]>,
}

/// What the sources are built with.
#[derive(Debug, Clone)]
pub(crate) struct SourceContext<'a> {
    pub(crate) rotor: &'a WakeRotor,
    pub(crate) settings: &'a FreeWakeSettings,
    pub(crate) roll_up: RollUp,
    pub(crate) circulation: &'a CirculationMap,
    pub(crate) advance_ratio: f64,
    /// Chord of the blades at the tip, unit `R`; 0 if the wake leaves at the lifting line.
    pub(crate) chord: f64,
    /// Displacement of the wake in one turn at its free end.
    pub(crate) turn: Vec3,
}

impl SourceContext<'_> {
    /// What the segment of filament `f` from an age to the next one carries.
    fn rolled_up_terms(&self, f: usize, past: Past, age: usize) -> Terms {
        let releases = [age, age + 1].map(|age| past.row(age));
        self.roll_up.terms(f, releases, self.rotor.panels())
    }

    /// Strength of the same.
    pub(crate) fn rolled_up_strength(&self, f: usize, past: Past, age: usize) -> f64 {
        self.rolled_up_terms(f, past, age).strength(self.circulation.values())
    }

    /// Core radius of the same.
    pub(crate) fn rolled_up_radius(&self, f: usize, past: Past, age: usize) -> f64 {
        core_radius(self.settings, age, self.rolled_up_strength(f, past, age))
    }

    /// What the trailer of a node carries from an age to the next one.
    fn trailer_terms(&self, node: usize, past: Past, age: usize) -> Terms {
        let [[a, b], [c, d]] =
            [age, age + 1].map(|age| self.trailed_terms(node, past.row(age), 0.5));
        Terms([a, b, c, d])
    }

    /// A factor times what a node trails of the circulation of a row: inboard and outboard panel.
    fn trailed_terms(&self, node: usize, row: usize, factor: f64) -> [(usize, f64); 2] {
        let panels = self.rotor.panels();
        let at = row * panels;
        let inboard = if node > 0 { (at + node - 1, factor) } else { (0, 0.0) };
        let outboard = if node < panels { (at + node, -factor) } else { (0, 0.0) };
        [inboard, outboard]
    }

    /// Strength of the same.
    pub(crate) fn trailer_strength(&self, node: usize, past: Past, age: usize) -> f64 {
        self.trailer_terms(node, past, age).strength(self.circulation.values())
    }

    /// Core radius of the same: in the sheet of the own blade no wider than its panels ask for; but no less than a chord for
    /// sections in slow or reverse flow, whose sheet lies on the blade.
    pub(crate) fn trailer_radius(&self, node: usize, past: Past, age: usize) -> f64 {
        let azimuth = past.back(age) % self.settings.azimuths;
        let released = azimuth as f64 * self.settings.step_rad();
        let along = self.rotor.nodes()[node] + self.advance_ratio * released.sin();
        let near = self.settings.core.near_radius;
        match (age < self.settings.sheet_steps(), along >= SLOW.min(self.advance_ratio)) {
            (true, true) => young_radius(self, node),
            (true, false) => near.max(self.chord),
            (false, _) => near,
        }
    }
}

/// One segment.
#[derive(Debug, Clone)]
struct Source {
    ends: [Vec3; 2],
    radius: f64,
    terms: Terms,
    /// Whether it may be summed in single precision.
    old: bool,
}

/// Segments of one instant.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sources(Vec<Source>);

impl Sources {
    /// What the blades feel: lifting lines, the full span of the near wake, the rolled-up vortices behind it.
    pub(crate) fn of_loads(views: &[BladeView<'_>], context: &SourceContext<'_>) -> Self {
        let mut out = Self::with_room(views, context);
        for view in views {
            out.bound(view, context);
            out.chords(view, context, |n| context.trailer_radius(n, view.past, 0));
            out.near(view, context, 0.0);
            out.far(view, context, context.settings.near_steps(), 0.0);
        }
        out
    }

    /// What the rolled-up vortices feel: lifting lines and themselves, rolled up from the blade on. The sheet
    /// of the near wake, that rolls up around them, would lift them off their own track. Where the near wake is free, its
    /// trailers are felt in place of the young vortices. What moves freely moves what moves freely with mutual cores.
    pub(crate) fn of_geometry(views: &[BladeView<'_>], context: &SourceContext<'_>) -> Self {
        let core = &context.settings.core;
        let free = context.settings.near_wake_motion == NearWakeMotion::Free;
        let mut out = Self::default();
        for view in views {
            out.bound(view, context);
            if free {
                out.chords(view, context, |n| context.trailer_radius(n, view.past, 0));
                out.near(view, context, core.mutual_radius);
                out.far(view, context, context.settings.near_steps(), core.mutual_radius);
            } else {
                // about to roll up: as thick as what comes of them
                out.chords(view, context, |_| core.radius);
                out.far(view, context, 0, core.mutual_radius);
            }
        }
        out
    }

    /// None yet, with room for all that the blades feel.
    fn with_room(views: &[BladeView<'_>], context: &SourceContext<'_>) -> Self {
        let SourceContext { settings, .. } = context;
        let of = |BladeView { line, near, far, .. }: &BladeView<'_>| {
            let ages =
                far.iter().map(|points| points.len() + settings.far_turns * settings.azimuths);
            2 * line.len() + 2 * near.len() * settings.near_steps() + ages.sum::<usize>()
        };
        Self(Vec::with_capacity(views.iter().map(of).sum()))
    }

    /// How the strength of a segment depends on the circulation.
    pub(crate) fn terms(&self, segment: usize) -> &Terms {
        &self.0[segment].terms
    }

    /// For the kernel, with the strengths of a circulation.
    pub(crate) fn segments(&self, context: &SourceContext<'_>, circulation: &[f64]) -> SegmentSet {
        let mut set = SegmentSet::new(context.settings.core.model);
        let single = context.settings.far_field == FarField::Single;
        for Source { ends: [start, end], radius, terms, old } in &self.0 {
            let strength = terms.strength(circulation);
            if single && *old {
                set.push_single(*start, *end, strength, *radius);
            } else {
                set.push(*start, *end, strength, *radius);
            }
        }
        set
    }

    /// For the kernel, all of unit strength and in double precision.
    pub(crate) fn unit_segments(&self, context: &SourceContext<'_>) -> SegmentSet {
        let mut set = SegmentSet::with_room(context.settings.core.model, self.0.len());
        for Source { ends: [start, end], radius, .. } in &self.0 {
            set.push(*start, *end, 1.0, *radius);
        }
        set
    }

    /// Adds a segment, if it carries anything.
    fn push(&mut self, ends: [Vec3; 2], radius: f64, terms: Terms, old: bool) {
        if terms.iter().next().is_some() {
            self.0.push(Source { ends, radius, terms, old });
        }
    }

    fn bound(&mut self, view: &BladeView<'_>, context: &SourceContext<'_>) {
        let panels = context.rotor.panels();
        for (s, ends) in view.line.windows(2).enumerate() {
            let terms = Terms::pair((view.past.row(0) * panels + s, 1.0), (0, 0.0));
            self.push([ends[0], ends[1]], context.settings.core.near_radius, terms, false);
        }
    }

    /// Along the chord to where the trailers leave, with a core radius by node.
    fn chords(
        &mut self,
        view: &BladeView<'_>,
        context: &SourceContext<'_>,
        radius: impl Fn(usize) -> f64,
    ) {
        for (n, (from, to)) in view.line.iter().zip(view.edge).enumerate() {
            if norm(sub(*to, *from)) > 0.0 {
                let [inboard, outboard] = context.trailed_terms(n, view.past.row(0), 1.0);
                self.push([*from, *to], radius(n), Terms::pair(inboard, outboard), false);
            }
        }
    }

    /// Trailers and shed vortices of the near wake, with cores no thinner than `least`.
    fn near(&mut self, view: &BladeView<'_>, context: &SourceContext<'_>, least: f64) {
        let (settings, panels) = (context.settings, context.rotor.panels());
        let steps = settings.near_steps();
        for (n, points) in view.near.iter().enumerate() {
            for k in 0..steps {
                let radius = context.trailer_radius(n, view.past, k).max(least);
                let terms = context.trailer_terms(n, view.past, k);
                self.push([points[k], points[k + 1]], radius, terms, false);
            }
        }
        if settings.shed == ShedVorticity::InSections {
            return;
        }
        for k in 0..steps {
            // at the edge itself the circulation changes from the blade's own
            let [younger, older] =
                [k.saturating_sub(1), k + 1].map(|age| view.past.row(age) * panels);
            for s in 0..panels {
                let ends = [view.near[s][k], view.near[s + 1][k]];
                let radius = settings.core.near_radius.max(least);
                let terms = Terms::pair((older + s, 0.5), (younger + s, -0.5));
                self.push(ends, radius, terms, false);
            }
        }
    }

    /// Rolled-up filaments from an age (steps) on and their repeated last turn, with cores no thinner than `least`.
    fn far(&mut self, view: &BladeView<'_>, context: &SourceContext<'_>, first: usize, least: f64) {
        let settings = context.settings;
        let azimuths = settings.azimuths;
        for (f, points) in view.far.iter().enumerate() {
            let steps = points.len() - 1;
            let terms = |age: usize| context.rolled_up_terms(f, view.past, age);
            let radius = |age: usize| context.rolled_up_radius(f, view.past, age).max(least);
            // point of an age; behind the free turns the last one is repeated
            let point = |age: usize| match age.checked_sub(steps + 1) {
                None => points[age],
                Some(beyond) => {
                    let turn = scale(context.turn, (beyond / azimuths + 1) as f64);
                    add(points[steps - azimuths + beyond % azimuths + 1], turn)
                }
            };
            for age in first..steps + settings.far_turns * azimuths {
                let ends = [point(age), point(age + 1)];
                self.push(ends, radius(age), terms(age), age >= azimuths);
            }
        }
    }
}

/// Core radius of the trailers of a node while the next blade is far.
fn young_radius(context: &SourceContext<'_>, node: usize) -> f64 {
    let nodes = context.rotor.nodes();
    let inboard = node.checked_sub(1).map(|n| nodes[node] - nodes[n]);
    let outboard = nodes.get(node + 1).map(|next| next - nodes[node]);
    let width = inboard.into_iter().chain(outboard).fold(f64::INFINITY, f64::min);
    let core = &context.settings.core;
    core.near_radius.min(core.panel_share * width)
}

/// Core radius of a rolled-up segment by age (steps) and strength.
fn core_radius(settings: &FreeWakeSettings, age: usize, strength: f64) -> f64 {
    let core = &settings.core;
    let eddy = core.viscosity + core.squire * strength.abs();
    let growth =
        if core.viscosity > 0.0 { eddy * (age as f64 + 0.5) * settings.step_rad() } else { 0.0 };
    (core.radius * core.radius + 4.0 * ALPHA * growth).sqrt()
}
