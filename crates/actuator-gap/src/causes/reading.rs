//! What a sensor can read of a motion.

/// What a sensor makes of a motion: a gain and a zero, then what it can read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reading {
    /// Reading over motion.
    pub(super) gain: f64,
    /// Reading of no motion, output's unit.
    pub(super) zero: f64,
    /// Highest reading, output's unit.
    pub(super) most: f64,
    /// Lowest reading, output's unit.
    pub(super) least: f64,
    /// Fastest change of the reading, output's unit per s.
    pub(super) fastest: f64,
}

impl Reading {
    pub(super) const FREE: Self = Self {
        gain: 1.0,
        zero: 0.0,
        most: f64::INFINITY,
        least: f64::NEG_INFINITY,
        fastest: f64::INFINITY,
    };

    /// What it reads of a motion.
    pub(crate) fn of(&self, motion: &[f64], step_s: f64) -> Vec<f64> {
        let most = self.fastest * step_s;
        let shown = || motion.iter().map(|x| self.gain * x + self.zero);
        let mut read = shown().next().unwrap_or_default();
        shown()
            .map(|y| {
                read += (y - read).clamp(-most, most);
                read.min(self.most).max(self.least)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Reading;
    use approx::assert_abs_diff_eq;

    #[test]
    fn a_reading_ends_at_its_range_and_follows_no_faster_than_it_can() {
        let motion = [0.0, 10.0, 10.0, 10.0, -20.0];
        assert_eq!(
            Reading { most: 8.0, least: -9.0, ..Reading::FREE }.of(&motion, 0.1),
            [0.0, 8.0, 8.0, 8.0, -9.0]
        );
        let other = Reading { gain: 1.1, zero: 0.5, ..Reading::FREE };
        assert_abs_diff_eq!(other.of(&motion, 0.1)[1], 11.5, epsilon = 1e-12);
        let late = Reading { fastest: 40.0, ..Reading::FREE }.of(&motion, 0.1);
        for (read, expected) in late.iter().zip([0.0, 4.0, 8.0, 10.0, 6.0]) {
            assert_abs_diff_eq!(*read, expected, epsilon = 1e-12);
        }
    }
}
