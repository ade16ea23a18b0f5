//! The revolution of a rotor and its wake for `ParaView`: a VTK file (XML, ASCII) for each azimuth, and the collection that
//! plays them.
//!
//! Lengths in m, hub axes that do not turn, from the hub centre: X aft, Y starboard, Z up along the shaft.
//!
//! | array | of | meaning |
//! |---|---|---|
//! | `age_deg` | points | age of a vortex, deg of azimuth since it left its blade; 0 elsewhere |
//! | `circulation_m2_s` | points | right-hand sense about the direction of growing age; 0 elsewhere |
//! | `core_radius_m` | points | core radius of a vortex as the blades feel it; 0 elsewhere |
//! | `kind` | cells | 0 blade, 1 near wake, 2 rolled-up vortex, 3 disk |
//! | `blade` | cells | blade of a line or a panel, from 1; 0 for the disk |
//! | `cn_m2` | cells | `C_n M^2` of the section in the middle of the panel, normal to the chord, up positive; blades and disk |
//! | `thrust_N_per_m` | cells | lift per length along the shaft, up positive, mean over the panel; blades and disk |

use rotor_base::RotorScales;
use rotor_study::DiskLoads;
use rotor_wake::{FilamentStates, FreeWake, SegmentState, Vec3, WakeFilament};
use std::fmt::Write as _;

/// What a filament carries at its nodes: that of the segment behind a node, of the last one at its end; nothing where the
/// near wake stands for it.
pub(crate) fn at_nodes(
    filament: &WakeFilament,
    states: &[Vec<SegmentState>],
    azimuth: usize,
) -> Vec<SegmentState> {
    let states = &states[azimuth];
    let last = states.len().saturating_sub(1);
    let at = |k: usize| states.get(k.min(last)).copied().filter(|_| k >= filament.first_age);
    (0..filament.points[azimuth].len()).map(|k| at(k).unwrap_or_default()).collect()
}

/// What the files show.
pub(crate) struct Revolution<'a> {
    pub(crate) wake: &'a FreeWake,
    /// Of the rolled-up vortices and of the near wake.
    pub(crate) states: &'a [Vec<FilamentStates>; 2],
    /// On the panels and azimuths of the wake.
    pub(crate) disk: &'a DiskLoads,
    pub(crate) scales: RotorScales,
}

/// Kinds of cells.
const BLADE: u8 = 0;
const NEAR: u8 = 1;
const ROLLED_UP: u8 = 2;
const DISK: u8 = 3;

/// `wake.pvd`, and in the folder `revolution` a file for each azimuth of the first blade.
pub(crate) fn revolution_files(of: &Revolution<'_>) -> Vec<(String, String)> {
    let azimuths = of.wake.settings().azimuths;
    let step_deg = of.wake.settings().step_rad().to_degrees();
    let name = |i: usize| format!("revolution/azimuth_{i:03}.vtp");
    let mut collection = String::from(
        "<?xml version=\"1.0\"?>\n<!-- timestep: azimuth of blade 1, deg, 0 over the tail -->\n\
         <VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for i in 0..azimuths {
        let (azimuth, file) = (i as f64 * step_deg, name(i));
        let _ =
            writeln!(collection, "<DataSet timestep=\"{azimuth}\" part=\"0\" file=\"{file}\"/>");
    }
    collection.push_str("</Collection>\n</VTKFile>\n");
    let disk = of.disk_points();
    let files = (0..azimuths).map(|i| (name(i), of.at(i, &disk).text()));
    std::iter::once(("wake.pvd".to_owned(), collection)).chain(files).collect()
}

impl Revolution<'_> {
    /// The picture with the first blade at one azimuth of the grid.
    fn at(&self, azimuth: usize, disk: &[Vec3]) -> Picture {
        let (wake, azimuths) = (self.wake, self.wake.settings().azimuths);
        let step_deg = wake.settings().step_rad().to_degrees();
        let radius_m = self.scales.radius_m();
        let (near, far) = (wake.near_wake(), wake.vortices());
        let [far_states, near_states] = self.states;
        let mut picture = Picture::default();
        for blade in 0..wake.rotor().blades() {
            let i = (azimuth + blade * azimuths / wake.rotor().blades()) % azimuths;
            for (kind, filaments, of) in [(NEAR, &near, near_states), (ROLLED_UP, &far, far_states)]
            {
                for (filament, states) in filaments.iter().zip(of) {
                    let first = picture.points.len();
                    for (k, state) in at_nodes(filament, states, i).into_iter().enumerate() {
                        let circulation =
                            state.circulation * self.scales.tip_speed_m_s() * radius_m;
                        let vortex =
                            [k as f64 * step_deg, circulation, radius_m * state.core_radius];
                        picture.points.push((filament.points[i][k].map(|x| radius_m * x), vortex));
                    }
                    let line = (first..picture.points.len()).collect();
                    let loads = [0.0; 2];
                    picture.lines.push(Cell { points: line, kind, blade: blade + 1, loads });
                }
            }
        }
        for blade in 0..wake.rotor().blades() {
            let i = (azimuth + blade * azimuths / wake.rotor().blades()) % azimuths;
            let first = picture.points.len();
            // the line is a quarter chord behind the leading edge, the trailing edge three more
            for (line, trailing) in wake.lines().at(i).iter().zip(wake.lines().edge_at(i)) {
                let leading = std::array::from_fn(|c| line[c] - (trailing[c] - line[c]) / 3.0);
                for edge in [leading, *trailing] {
                    picture.points.push((edge.map(|x| radius_m * x), [0.0; 3]));
                }
            }
            for k in 0..self.disk.panels() {
                let at = first + 2 * k;
                let points = vec![at, at + 2, at + 3, at + 1];
                let loads = self.loads(i, k);
                picture.quads.push(Cell { points, kind: BLADE, blade: blade + 1, loads });
            }
        }
        self.add_disk(&mut picture, disk);
        picture
    }

    /// `C_n M^2` and thrust per length of a blade at an azimuth and panel.
    fn loads(&self, azimuth: usize, panel: usize) -> [f64; 2] {
        let at = azimuth * self.disk.panels() + panel;
        [self.disk.cn_m2[at], self.disk.thrust_newton_per_m[at]]
    }

    /// Corners of the disk: where the lines of the blades pass half way between two azimuths, the panels' ends at each.
    fn disk_points(&self) -> Vec<Vec3> {
        let (wake, azimuths) = (self.wake, self.wake.settings().azimuths);
        let corner = |i: usize, n: usize| {
            let (sin, cos) = ((i as f64 - 0.5) * wake.settings().step_rad()).sin_cos();
            let up = |i: usize| wake.lines().at(i % azimuths)[n][2];
            let r = self.disk.edges_r[n];
            [r * cos, r * sin, 0.5 * (up(i + azimuths - 1) + up(i))]
                .map(|x| self.scales.radius_m() * x)
        };
        (0..azimuths)
            .flat_map(|i| (0..self.disk.edges_r.len()).map(move |n| corner(i, n)))
            .collect()
    }

    fn add_disk(&self, picture: &mut Picture, corners: &[Vec3]) {
        let (first, nodes) = (picture.points.len(), self.disk.edges_r.len());
        picture.points.extend(corners.iter().map(|point| (*point, [0.0; 3])));
        let azimuths = self.disk.azimuths();
        for i in 0..azimuths {
            let [here, next] = [i, (i + 1) % azimuths].map(|i| first + i * nodes);
            for k in 0..self.disk.panels() {
                let points = vec![here + k, here + k + 1, next + k + 1, next + k];
                picture.quads.push(Cell { points, kind: DISK, blade: 0, loads: self.loads(i, k) });
            }
        }
    }
}

/// A line or a quad.
struct Cell {
    points: Vec<usize>,
    kind: u8,
    blade: usize,
    /// `cn_m2` and `thrust_N_per_m`.
    loads: [f64; 2],
}

/// What one file holds.
#[derive(Default)]
struct Picture {
    /// Each with age, circulation and core radius.
    points: Vec<(Vec3, [f64; 3])>,
    lines: Vec<Cell>,
    quads: Vec<Cell>,
}

impl Picture {
    fn text(&self) -> String {
        let [points, lines, quads] = [self.points.len(), self.lines.len(), self.quads.len()];
        let mut out = format!(
            "<?xml version=\"1.0\"?>\n\
             <!-- m, hub axes: X aft, Y starboard, Z up; kind: 0 blade, 1 near wake, 2 rolled-up vortex, 3 disk -->\n\
             <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n\
             <Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"0\" NumberOfLines=\"{lines}\" NumberOfStrips=\"0\" NumberOfPolys=\"{quads}\">\n"
        );
        let number = |x: f64| format!("{x:.6e}");
        out.push_str("<PointData>\n");
        for (c, name) in ["age_deg", "circulation_m2_s", "core_radius_m"].into_iter().enumerate() {
            array(&mut out, name, "Float64", 1, self.points.iter().map(|(_, of)| number(of[c])));
        }
        out.push_str("</PointData>\n<CellData>\n");
        let cells = || self.lines.iter().chain(&self.quads);
        array(&mut out, "kind", "Int32", 1, cells().map(|cell| cell.kind.to_string()));
        array(&mut out, "blade", "Int32", 1, cells().map(|cell| cell.blade.to_string()));
        for (c, name) in ["cn_m2", "thrust_N_per_m"].into_iter().enumerate() {
            array(&mut out, name, "Float64", 1, cells().map(|cell| number(cell.loads[c])));
        }
        out.push_str("</CellData>\n<Points>\n");
        let places = self.points.iter().flat_map(|(point, _)| point.map(number));
        array(&mut out, "points", "Float64", 3, places);
        out.push_str("</Points>\n");
        for (name, cells) in [("Lines", &self.lines), ("Polys", &self.quads)] {
            let _ = writeln!(out, "<{name}>");
            let points = cells.iter().flat_map(|cell| cell.points.iter().map(usize::to_string));
            array(&mut out, "connectivity", "Int64", 1, points);
            let ends = cells.iter().scan(0, |end, cell| {
                *end += cell.points.len();
                Some(end.to_string())
            });
            array(&mut out, "offsets", "Int64", 1, ends);
            let _ = writeln!(out, "</{name}>");
        }
        out.push_str("</Piece>\n</PolyData>\n</VTKFile>\n");
        out
    }
}

fn array(
    out: &mut String,
    name: &str,
    kind: &str,
    components: usize,
    values: impl Iterator<Item = String>,
) {
    let _ = writeln!(
        out,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">"
    );
    for value in values {
        out.push_str(&value);
        out.push('\n');
    }
    out.push_str("</DataArray>\n");
}
