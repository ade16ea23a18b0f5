//! The files that `hhc` writes into folders, and by what each is known: nothing else of that name is replaced unasked.

use report_page::MADE_HERE;

/// Files in a folder: name of each, and a text that is in every one `hhc` writes under that name.
pub type Known = [(&'static str, &'static str)];

/// Files of a run.
pub const RUN_FILES: &Known = &[
    ("result.json", "\"program\": \"hhc "),
    ("blade_loads.csv", "azimuth_deg,station_r,axial_force_N,"),
    ("airloads.csv", "station_r,azimuth_deg,cn_m2,"),
    ("tip.csv", "azimuth_deg,flap_percent_r,"),
    VORTICES,
    ("histories.csv", "set,actuator,flap,azimuth_deg,voltage_V,"),
    ("sensitivity.csv", "id,assumption,"),
    ("robustness.csv", "per_rev,controller,"),
    ("costs.csv", "per_rev,actuator,of,quantity,unit,"),
    ("fronts.csv", "per_rev,against,point,j_over_j0,"),
    ("measured.csv", "quantity,station_r,figure,per_rev,"),
    ("figure.svg", "What control leaves of the vibration"),
    ("report.html", MADE_HERE),
];
const VORTICES: (&str, &str) = ("vortices.csv", "blade_azimuth_deg,plane_y_r,age_deg,");
/// Files of a flight, but for those beside it.
pub const FLIGHT_FILES: &Known =
    &[("flight.csv", "controller,time_s,advance_ratio,"), ("flight.html", MADE_HERE)];
/// Files of a free wake, but for the azimuths in the folder `revolution`.
pub const WAKE_FILES: &Known = &[
    ("wake_geometry.csv", "kind,filament,release_r,azimuth_deg,"),
    ("wake.vtk", "# vtk DataFile"),
    VORTICES,
    ("inflow_map.csv", "azimuth_deg,r,induced_inflow"),
    ("convergence.csv", "azimuths,displacement_r,inflow_change,"),
    ("wake.pvd", "<!-- timestep: azimuth of blade 1, deg"),
];
/// Files of a wake in time.
pub const IN_TIME_FILES: &Known = &[("in_time.csv", "revolution,measured,theta0_deg,")];
/// Files of a comparison.
pub const COMPARE_FILES: &Known =
    &[("compare.csv", "name,unit,per_rev,a,a_phase_deg,"), ("compare.html", MADE_HERE)];
/// Files of merged results of a sweep.
pub const MERGED_FILES: &Known = &[("sweep.csv", ",warnings,key\n"), ("sweep.json", "\"axes\": [")];
/// The page of a sweep.
pub const SWEEP_PAGE: &Known = &[("sweep.html", MADE_HERE)];
/// Files of a diagnosis, but for the tables of its runs.
pub const DIAGNOSIS_FILES: &Known = &[
    ("findings.json", "\"data_kind\": \""),
    ("report.html", MADE_HERE),
    ("residuals.csv", "point,channel,measured,simulated,sd,"),
    ("extended_case.ron", "#![enable(implicit_some, unwrap_variant_newtypes)]"),
];
/// What is said of several specimens.
pub const SPECIMENS_FILES: &Known = &[("specimens.json", "\"specimens\": [")];
/// The file of a plan.
pub const PLAN_FILES: &Known = &[("plan.json", "\"noise_um\": ")];
/// The file of a ladder.
pub const LADDER_FILES: &Known = &[("ladder.json", "\"rungs\": [")];
