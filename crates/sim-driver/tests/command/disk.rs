//! What a run writes about the wake and the disk: crossings of vortices, files for `ParaView`, maps of the report.

use crate::place::{Place, QUICK_CASE, SMALL_WAKE};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// The quick case in a small free wake, of an own radius and planes.
fn small_case() -> String {
    QUICK_CASE.replace(
        "(model: Uniform)",
        &format!(
            "(model: {SMALL_WAKE}), rotor: (radius_m: 2.0), response: (vortex_planes_y_r: [0.8, -0.5])"
        ),
    )
}

/// Rows of numbers behind a header.
fn rows(text: &str, header: &str) -> Vec<Vec<f64>> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(header));
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    lines.map(row).collect()
}

/// The crossings of a run are those of the lines between the nodes of the tip vortex that `hhc wake` writes.
#[test]
fn vortices_cut_planes_where_the_wake_is() {
    let place = Place::new();
    place.write("case.ron", &small_case());
    place.hhc(&["run", "case.ron", "--out", "run"]).done();
    place.hhc(&["wake", "case.ron", "--out", "wake"]).done();
    let text = place.read("run/vortices.csv");
    assert_eq!(text, place.read("wake/vortices.csv"));
    let found = rows(&text, "blade_azimuth_deg,plane_y_r,age_deg,x_m,y_m,z_m");
    assert!(found.len() > 2 * 12 * 4, "{}", found.len());
    // nodes of the tip vortex, the last filament, by azimuth of its blade; a younger one is where the near wake is
    let geometry = place.read("wake/wake_geometry.csv");
    let mut nodes: BTreeMap<(usize, usize), [f64; 3]> = BTreeMap::new();
    for line in geometry.lines().filter(|line| line.starts_with("rolled_up,5,")) {
        let cells: Vec<f64> = line.split(',').skip(1).map(|cell| cell.parse().unwrap()).collect();
        let step = |deg: f64| (0..99).find(|k| (f64::from(*k) * 30.0 - deg).abs() < 1e-6).unwrap();
        let key = [step(cells[2]), step(cells[3])].map(|k| usize::try_from(k).unwrap());
        nodes.insert(key.into(), [cells[4], cells[5], cells[6]]);
    }
    let mut expected = Vec::new();
    for (instant, plane) in (0..12).flat_map(|i| [(i, 0.8), (i, -0.5)]) {
        for blade in 0..4 {
            let of_blade = (instant + 3 * blade) % 12;
            for age in 0..24 {
                let at = |age| nodes.get(&(of_blade, age));
                let Some((a, b)) = at(age).zip(at(age + 1)) else { continue };
                if (a[1] - plane) * (b[1] - plane) < 0.0 {
                    let t = (plane - a[1]) / (b[1] - a[1]);
                    let point = |c: usize| 2.0 * (a[c] + t * (b[c] - a[c]));
                    let age_deg = 30.0 * (age as f64 + t);
                    expected.push([
                        30.0 * instant as f64,
                        plane,
                        age_deg,
                        point(0),
                        point(1),
                        point(2),
                    ]);
                }
            }
        }
    }
    // the nodes written begin where the near wake ends
    let old: Vec<&Vec<f64>> = found.iter().filter(|row| row[2] > 360.0).collect();
    assert_eq!(old.len(), expected.len());
    for (row, expected) in old.iter().zip(&expected) {
        for (k, (a, b)) in row.iter().zip(expected).enumerate() {
            // nodes are written to 1e-6 R
            assert!((a - b).abs() < if k == 2 { 1e-2 } else { 1e-4 }, "{row:?} {expected:?}");
        }
        assert!((row[4] - 2.0 * row[1]).abs() < 1e-6, "{row:?}");
    }
    // without a free wake nothing is cut
    place.write("even.ron", QUICK_CASE);
    place.hhc(&["run", "even.ron", "--out", "even"]).done();
    assert!(!place.path().join("even/vortices.csv").exists());
}

/// An XML file of VTK: its arrays by the element they stand in and their name, and its counts.
struct Vtp {
    arrays: BTreeMap<String, Vec<f64>>,
    counts: BTreeMap<String, usize>,
}

fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let (_, rest) = tag.split_once(&format!(" {name}=\"")).unwrap();
    rest.split_once('"').unwrap().0
}

/// Reads elements that open and close in order, as any reader of XML does.
fn vtp(text: &str) -> Vtp {
    let mut open: Vec<&str> = Vec::new();
    let (mut arrays, mut counts) = (BTreeMap::new(), BTreeMap::new());
    for part in text.split('<').skip(1) {
        let (tag, content) = part.split_once('>').unwrap();
        if tag.starts_with(['?', '!']) {
            continue;
        }
        let name = tag.split(' ').next().unwrap();
        if let Some(closed) = name.strip_prefix('/') {
            assert_eq!(open.pop(), Some(closed));
            continue;
        }
        if name == "DataArray" {
            assert_eq!(attribute(tag, "format"), "ascii");
            let values = content.split_whitespace().map(|value| value.parse().unwrap()).collect();
            let inside = open.last().unwrap();
            arrays.insert(format!("{inside}/{}", attribute(tag, "Name")), values);
        }
        if name == "Piece" {
            for count in ["Points", "Verts", "Lines", "Strips", "Polys"] {
                let number = attribute(tag, &format!("NumberOf{count}")).parse().unwrap();
                counts.insert(count.to_owned(), number);
            }
        }
        open.push(name);
    }
    assert!(open.is_empty(), "{open:?}");
    Vtp { arrays, counts }
}

impl Vtp {
    #[track_caller]
    fn of(&self, name: &str) -> &[f64] {
        self.arrays.get(name).unwrap_or_else(|| panic!("no {name}"))
    }

    /// Points of every cell of a kind of element, whose numbers are in range.
    #[track_caller]
    fn cells(&self, element: &str) -> Vec<Vec<[f64; 3]>> {
        let points: Vec<[f64; 3]> =
            self.of("Points/points").chunks(3).map(|p| [p[0], p[1], p[2]]).collect();
        let number = |x: f64| {
            assert!(x >= 0.0 && x.fract() == 0.0, "{x}");
            format!("{x}").parse::<usize>().unwrap()
        };
        let connected = self.of(&format!("{element}/connectivity"));
        let mut first = 0;
        let cells = self.of(&format!("{element}/offsets")).iter().map(|end| {
            let end = number(*end);
            let cell = connected[first..end].iter().map(|at| points[number(*at)]).collect();
            first = end;
            cell
        });
        let cells: Vec<Vec<[f64; 3]>> = cells.collect();
        assert_eq!((first, cells.len()), (connected.len(), self.counts[element]));
        cells
    }
}

/// The collection names every file there is, once each azimuth; each file is whole; the loads of its disk and, over the
/// revolution, those of a blade make the thrust of the rotor.
#[test]
fn the_revolution_can_be_played() {
    let place = Place::new();
    place.write("case.ron", &small_case());
    let result = place.hhc(&["wake", "case.ron", "--out", "wake", "--format", "json"]).json();
    let collection = place.read("wake/wake.pvd");
    let sets: Vec<&str> =
        collection.split('<').filter(|part| part.starts_with("DataSet ")).collect();
    let mut named: Vec<String> =
        sets.iter().map(|set| format!("wake/{}", attribute(set, "file"))).collect();
    for (i, set) in sets.iter().enumerate() {
        let azimuth: f64 = attribute(set, "timestep").parse().unwrap();
        assert!((azimuth - 30.0 * i as f64).abs() < 1e-9, "{set}");
    }
    let files = place.listing();
    let files: Vec<String> =
        files.into_iter().filter(|name| name.starts_with("wake/revolution/")).collect();
    assert_eq!(named.len(), 12);
    let pictures: Vec<Vtp> = named.iter().map(|name| vtp(&place.read(name))).collect();
    named.sort();
    assert_eq!(named, files);

    let omega = 383.0 * TAU / 60.0;
    let solidity = 4.0 * 0.055 / std::f64::consts::PI;
    // C_T of pi rho R^2 (Omega R)^2; rho of Lock's number: gamma m0 R^3 / 3 = rho 2 pi c R^4
    let density = 5.2 * 6.46 / (3.0 * TAU * 0.055 * 4.0);
    let ct = result["ct_sigma"].as_f64().unwrap() * solidity;
    let thrust = ct * std::f64::consts::PI * density * 4.0 * (omega * 2.0_f64).powi(2);
    let mut by_blade = [0.0; 4];
    for (azimuth, picture) in pictures.iter().enumerate() {
        let [points, lines, quads] = ["Points", "Lines", "Polys"].map(|name| picture.counts[name]);
        assert_eq!(picture.of("Points/points").len(), 3 * points);
        for name in ["age_deg", "circulation_m2_s", "core_radius_m"] {
            assert_eq!(picture.of(&format!("PointData/{name}")).len(), points, "{name}");
        }
        for name in ["kind", "blade", "cn_m2", "thrust_N_per_m"] {
            assert_eq!(picture.of(&format!("CellData/{name}")).len(), lines + quads, "{name}");
        }
        // trailers and six rolled-up vortices of four blades; panels of the blades and of the disk
        let panels = quads / (4 + 12);
        assert_eq!((lines, quads), (4 * (panels + 1 + 6), (4 + 12) * panels));
        let (kinds, of_blade) = (picture.of("CellData/kind"), picture.of("CellData/blade"));
        let loads = picture.of("CellData/thrust_N_per_m");
        picture.cells("Lines");
        let radius = |p: &[f64; 3]| p[0].hypot(p[1]);
        let mut of_disk = 0.0;
        let mut widths = vec![0.0; panels];
        for (k, cell) in picture.cells("Polys").iter().enumerate().rev() {
            assert_eq!(cell.len(), 4);
            let at = lines + k;
            if kinds[at] > 2.5 {
                let width = radius(&cell[1]) - radius(&cell[0]);
                widths[k % panels] = width;
                of_disk += 4.0 / 12.0 * loads[at] * width;
            } else {
                assert!(kinds[at].abs() < 0.5);
                let blade = (0..4).find(|b| (of_blade[at] - f64::from(*b) - 1.0).abs() < 0.5);
                by_blade[usize::try_from(blade.unwrap()).unwrap()] +=
                    4.0 / 12.0 * loads[at] * widths[k % panels];
                // the blade is where it says: its tip flies at the azimuth of its number
                let psi = TAU * (azimuth as f64 / 12.0 + f64::from(blade.unwrap()) / 4.0);
                let [x, y, _] = cell[1];
                assert!(x * psi.cos() + y * psi.sin() > 0.9 * radius(&cell[1]), "{cell:?}");
            }
        }
        assert!((of_disk / thrust - 1.0).abs() < 2e-3, "{of_disk} {thrust}");
    }
    for sum in by_blade {
        assert!((sum / thrust - 1.0).abs() < 2e-3, "{by_blade:?} {thrust}");
    }
}

/// A wake of prescribed circulation has no sections, so nothing to play: what it is stands in the other files.
#[test]
fn a_prescribed_circulation_loads_no_disk() {
    let place = Place::new();
    let wake = "FreeWake(circulation: Prescribed(), azimuths: 12, turns: 2, panels: 8)";
    place.write("case.ron", &QUICK_CASE.replace("(model: Uniform)", &format!("(model: {wake})")));
    place.hhc(&["wake", "case.ron", "--out", "wake"]).done();
    assert!(!place.path().join("wake/wake.pvd").exists());
    assert!(place.read("wake/vortices.csv").lines().count() > 8 * 12);
}

/// The values that a map of the report colours, and its text.
fn maps(page: &str) -> Vec<(serde_json::Value, String)> {
    let (_, charts) = page.split_once("const charts = ").unwrap();
    let charts: serde_json::Value =
        serde_json::Deserializer::from_str(charts).into_iter().next().unwrap().unwrap();
    let charts = charts.as_array().unwrap().iter().map(|chart| chart["data"][0].clone());
    let charts: Vec<_> = charts.filter(|trace| trace["type"] == "barpolar").collect();
    let (_, text) = page.split_once("Over the disk").unwrap();
    let notes = text.split("<span class=\"note\">").skip(1);
    let notes = notes.map(|rest| rest.split_once("</span>").unwrap().0.to_owned());
    charts.into_iter().zip(notes).collect()
}

fn numbers(values: &serde_json::Value) -> Vec<f64> {
    values.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

fn extremes(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::MAX, f64::MIN], |[low, high], v| [low.min(*v), high.max(*v)])
}

/// In a free wake and in another inflow the report maps lift and induced velocity: value for value those of the airloads at
/// the same stations, extremes as written above the map.
#[test]
fn the_report_maps_the_disk() {
    let place = Place::new();
    for (case, azimuths) in [(small_case(), 12), (QUICK_CASE.to_owned(), 36)] {
        place.write("case.ron", &case);
        place.hhc(&["run", "case.ron", "--out", "o"]).done();
        let shown = maps(&place.read("o/report.html"));
        assert_eq!(shown.len(), 2);
        let stations: Vec<f64> = numbers(&shown[0].0["customdata"]);
        let panels = stations.len() / azimuths;
        let stations = &stations[..panels];
        let step = 360.0 / azimuths as f64;
        for (k, theta) in numbers(&shown[0].0["theta"]).iter().enumerate() {
            assert!((theta - (k / panels) as f64 * step).abs() < 1e-9, "{theta}");
        }
        // the same case with its loads at the middles of the panels
        let response = format!("load_stations_r: {stations:?}");
        let asked = if case.contains("response: (") {
            case.replace("response: (", &format!("response: ({response}, "))
        } else {
            case.replace("(model: Uniform)", &format!("(model: Uniform), response: ({response})"))
        };
        assert_ne!(asked, case);
        place.write("asked.ron", &asked);
        place.hhc(&["run", "asked.ron", "--out", "asked"]).done();
        let header = "station_r,azimuth_deg,cn_m2,cm_m2,cc_m2,cn,mach";
        let airloads = rows(&place.read("asked/airloads.csv"), header);
        let every = 360 / azimuths;
        let lift: Vec<f64> = (0..panels * azimuths)
            .map(|at| airloads[(at % panels) * 360 + at / panels * every][2])
            .collect();
        let drawn = numbers(&shown[0].0["marker"]["color"]);
        assert_eq!(drawn.len(), lift.len());
        for (a, b) in drawn.iter().zip(&lift) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
        let [low, high] = extremes(&lift);
        assert_eq!(shown[0].1, format!("{low:.4} to {high:.4}"));
        let induced = numbers(&shown[1].0["marker"]["color"]);
        let [low, high] = extremes(&induced);
        assert_eq!(shown[1].1, format!("{low:.4} to {high:.4} m/s"));
        // uniform inflow is the same everywhere, that of a free wake is not
        assert_eq!(high - low < 1e-9, azimuths == 36, "{low} {high}");
        // stored with the result: the report made again is the same
        let page = place.read("o/report.html");
        place.hhc(&["report", "o"]).done();
        assert_eq!(page, place.read("o/report.html"));
    }
}
