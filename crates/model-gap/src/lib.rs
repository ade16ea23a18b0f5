//! Measured against simulated: experiments, splits by experiment and measures of misfit.
