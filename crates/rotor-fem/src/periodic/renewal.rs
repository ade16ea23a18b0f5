//! When a kept factorisation is used again and when it is renewed.

/// Growth of the residual that a mixed step may cause before the matrix is renewed early.
const ALLOWED_GROWTH: f64 = 2.0;
/// Steps a new factorisation is given at first.
const PATIENCE: usize = 2;
/// Steps without a new best residual after which the search turns careful.
const STALL: usize = 8;

/// What to do with a chord step.
pub(crate) enum Verdict {
    /// Take it.
    Accept,
    /// It made things worse although the matrix is new: take a part of the Newton step.
    Shorten,
    /// The matrix has aged: make a new one.
    Renew,
}

/// Decides when the factorisation is renewed.
pub(crate) struct Renewal {
    /// Residual that a good step may leave, as a fraction.
    limit: f64,
    /// Steps since the matrix was made; none for one kept from an earlier solve.
    age: Option<usize>,
    /// Steps a new matrix is given before it may be replaced. Doubles when a new matrix did not help
    /// (the tangent is incomplete) and starts anew when it did.
    patience: usize,
    pub(crate) factorisations: usize,
    /// Steps since the best residual.
    stalled: usize,
    /// A new matrix for every step, and only steps that lower the residual.
    careful: bool,
}

impl Renewal {
    pub(crate) fn new(limit: f64) -> Self {
        Self { limit, age: None, patience: PATIENCE, factorisations: 0, stalled: 0, careful: false }
    }

    /// Notes that a new matrix was made.
    pub(crate) fn renewed(&mut self) {
        if self.factorisations > 0 {
            self.patience = self.patience.saturating_mul(2);
        }
        self.age = Some(0);
        self.factorisations += 1;
    }

    /// Notes whether a step gave a new best residual; true once, when chord steps have stalled and the
    /// search must go back to the best orbit and turn careful.
    pub(crate) fn stalls(&mut self, improved: bool) -> bool {
        self.stalled = if improved { 0 } else { self.stalled + 1 };
        let turns = !self.careful && self.stalled >= STALL;
        self.careful |= turns;
        turns
    }

    /// Whether the matrix of a step that was taken serves the next one too.
    pub(crate) fn keeps(&self) -> bool {
        !self.careful
    }

    /// Judges a step by the residual it leaves over the one it started from.
    pub(crate) fn judge(&mut self, growth: f64) -> Verdict {
        let good = growth <= self.limit;
        match self.age {
            Some(0) if good => self.patience = PATIENCE,
            Some(0) if growth >= 1.0 => {
                self.age = Some(1);
                return Verdict::Shorten;
            }
            Some(0) => {}
            Some(age) if !good && (age >= self.patience || growth > ALLOWED_GROWTH) => {
                return Verdict::Renew;
            }
            None if !good => return Verdict::Renew,
            _ => {}
        }
        self.age = self.age.map(|age| age + 1);
        Verdict::Accept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A search that never gets anywhere makes more matrices than a number has bits.
    #[test]
    fn patience_does_not_overflow() {
        let mut renewal = Renewal::new(0.5);
        for _ in 0..200 {
            renewal.renewed();
            assert!(matches!(renewal.judge(2.0), Verdict::Shorten));
        }
        assert_eq!(renewal.factorisations, 200);
    }
}
