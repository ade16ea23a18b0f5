//! Which effect a seed hides, on which base and how strong: functions of the seed alone.
//!
//! Seeds come in blocks of [`BLOCK`]. Each block holds 10 sets without effect, each cause of the library once, 4 pairs and
//! 4 effects outside the library (in turn), in an order that a hash of the block decides. A category meets
//! the bases in an order that a hash of the category decides: ten blocks, ten different bases.

use super::catalogue::{Cause, Hidden, Outside, PAIRS};
use super::design::BASES;
use super::draw::{Draw, Purpose};

/// Seeds in a block.
pub const BLOCK: u64 = (NULLS + Cause::ALL.len() + 2 * IN_TURN) as u64;

/// Sets without effect in a block.
const NULLS: usize = 10;
/// Pairs in a block, and effects outside the library.
const IN_TURN: usize = 4;

/// Range of the strength: rms of the effect over rms of the output.
pub const SHARE: (f64, f64) = (0.01, 0.08);

/// Each of two effects together is at least that strong.
const LEAST_SHARE_OF_PAIR: f64 = 0.03;

/// What a seed hides.
#[derive(Debug, Clone, PartialEq)]
pub struct Assignment {
    /// The effect.
    pub hidden: Hidden,
    /// The base.
    pub base: u64,
    /// Strength aimed at, one for each effect in it.
    pub shares: Vec<f64>,
}

impl Assignment {
    /// The assignment of a seed.
    #[expect(clippy::cast_possible_truncation, reason = "numbers below a block and turns of ten")]
    pub fn of_seed(seed: u64) -> Self {
        let (block, place) = (seed / BLOCK, (seed % BLOCK) as usize);
        let slot = Draw::new(Purpose::Assignment, &[0, block]).permutation(BLOCK as usize)[place];
        let causes = Cause::ALL.len();
        let turn = |n: usize, i: usize| (block as usize % 30 * IN_TURN + i) % n;
        let hidden = if slot < NULLS {
            Hidden::Null
        } else if let Some(cause) = Cause::ALL.get(slot - NULLS) {
            Hidden::One(*cause)
        } else if slot < NULLS + causes + IN_TURN {
            let (a, b) = PAIRS[turn(PAIRS.len(), slot - NULLS - causes)];
            Hidden::Two(a, b)
        } else {
            Hidden::Other(Outside::ALL[turn(Outside::ALL.len(), slot - NULLS - causes - IN_TURN)])
        };
        let cycle = [1, slot as u64, block / BASES];
        let order = Draw::new(Purpose::Assignment, &cycle).permutation(BASES as usize);
        let base = order[(block % BASES) as usize] as u64;
        Self { hidden, base, shares: Self::shares(hidden, seed) }
    }

    /// Another effect for a seed, with the strengths the seed would give it.
    #[must_use]
    pub fn with_hidden(self, hidden: Hidden, seed: u64) -> Self {
        Self { hidden, shares: Self::shares(hidden, seed), ..self }
    }

    fn shares(hidden: Hidden, seed: u64) -> Vec<f64> {
        let mut draw = Draw::new(Purpose::Assignment, &[2, seed]);
        match hidden {
            Hidden::Null => Vec::new(),
            Hidden::One(_) | Hidden::Other(_) => vec![draw.log_uniform(SHARE.0, SHARE.1)],
            Hidden::Two(..) => {
                (0..2).map(|_| draw.log_uniform(LEAST_SHARE_OF_PAIR, SHARE.1)).collect()
            }
        }
    }
}
