//! What every stage does once it is made ready for one time step.

/// A stage made ready for one time step.
pub trait Step {
    /// What the stage remembers.
    type Memory;

    /// The stage settled at an input, and its output there.
    fn start(&self, input: f64) -> (Self::Memory, f64);

    /// One sample on.
    fn advance(&self, memory: &mut Self::Memory, input: f64) -> f64;

    /// A whole signal through the stage, settled at its first sample and without load: the same
    /// numbers as sample by sample.
    fn pass(&self, signal: &mut [f64]) {
        let Some((first, rest)) = signal.split_first_mut() else {
            return;
        };
        let (mut memory, output) = self.start(*first);
        *first = output;
        for value in rest {
            *value = self.advance(&mut memory, *value);
        }
    }

    /// Whether a memory of this kind of stage is one of this stage.
    fn owns(&self, _memory: &Self::Memory) -> bool {
        true
    }

    /// Factor on the law's output that the present state means.
    fn gain(&self, _memory: &Self::Memory) -> f64 {
        1.0
    }

    /// Takes slow states to where a periodic input will leave them.
    ///
    /// ```text
    /// x(T) = e x(0) + b   =>   x* = (x(T) - e x(0)) / (1 - e),   e = exp(-T / tau)
    /// ```
    /// `e = exp(-way travelled / way)` where a state settles with the way.
    fn settle(&self, _before: &Self::Memory, _now: &mut Self::Memory, _period_s: f64) {}
}

/// The stages that have no memory: an output for every input.
pub trait Curve {
    /// The output at an input.
    fn value(&self, input: f64) -> f64;
}

impl<C: Curve> Step for C {
    type Memory = ();

    fn start(&self, input: f64) -> ((), f64) {
        ((), self.value(input))
    }

    #[inline]
    fn advance(&self, (): &mut (), input: f64) -> f64 {
        self.value(input)
    }
}
