//! Identification from a data folder of any kind.

use crate::BenchError;
use crate::curves::{CurveIdentification, identify_curves};
use crate::identification::{
    BenchIdentification, Compared, dataset_place, identify_bench, identify_loops,
};
use measured_data::DataSet;
use measured_data::problem::{Fault, Problem};
use preisach_dyn::identify::Settings;

/// What was identified from a data folder.
#[derive(Debug, Clone)]
pub enum FoundModel {
    /// From the runs of a bench or of two channels that loop.
    Records(Box<BenchIdentification>),
    /// From reversal curves.
    Curves(Box<CurveIdentification>),
}

/// Identifies the model of a data folder of any kind that has one.
///
/// # Errors
/// As [`identify_bench`], [`identify_loops`] and [`identify_curves`]; points of a rotor.
pub fn identified_data(
    data: &DataSet,
    base: &Settings,
    compared: Compared<'_>,
) -> Result<FoundModel, BenchError> {
    let of_records = |found| FoundModel::Records(Box::new(found));
    match data {
        DataSet::Bench(bench) => Ok(of_records(identify_bench(bench, base, compared)?)),
        DataSet::Loops(loops) => Ok(of_records(identify_loops(loops, base, compared)?)),
        DataSet::Curves(curves) => Ok(FoundModel::Curves(Box::new(identify_curves(curves)?))),
        DataSet::Sweep(sweep) => {
            let place = dataset_place(&sweep.folder).field("kind");
            let message =
                "points of a rotor identify no actuator: hhc diagnose CASE.ron --data DIR -o OUT"
                    .to_owned();
            Err(Problem::new(place, Fault::Refused { message }).into())
        }
    }
}
