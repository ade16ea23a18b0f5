//! What a diagnosis is asked.

use crate::record::Record;
use model_gap::discovery::Signal;
use preisach_dyn::ActuatorModel;

/// Keeps what surrogates leave on measured runs: it depends on the data alone and takes long.
pub trait StructureStore: Sync {
    /// The structures kept under `parts`, all the numbers they depend on; `lengths` are the samples of every measured
    /// run. None if there are no such.
    fn get(&self, parts: &[&[f64]], lengths: &[usize]) -> Option<Vec<Signal>>;
    /// Keeps structures; a store that cannot costs time, not results.
    fn keep(&self, parts: &[&[f64]], structures: &[Signal]);
}

/// What a diagnosis does, in its order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The base model is fitted.
    BaseModel,
    /// Surrogates say what is left with nothing missing.
    Surrogates,
    /// Causes are screened, fitted and tested.
    Search,
    /// Experiments are compared.
    NextExperiment,
}

/// What a diagnosis is asked.
#[derive(Clone, Default)]
pub struct Question<'a> {
    /// Reference runs from another folder.
    pub reference: Vec<Record>,
    /// Only these causes, all of them taken for true: what a refit with the known causes would gain.
    pub only: Vec<String>,
    /// Where surrogate structures are kept; none computes them anew.
    pub cache: Option<&'a dyn StructureStore>,
    /// The simulation that is asked about. Reference runs say how far it may be off; where there are none, it is what
    /// the measured runs are compared with.
    pub given: Option<&'a ActuatorModel>,
    /// Told of each stage as it begins.
    pub begun: Option<&'a dyn Fn(Stage)>,
}
