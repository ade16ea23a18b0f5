//! How an input is changed.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Words that readers stumble over.
const WORDS: [&str; 26] = [
    "-1",
    "0",
    "1e308",
    "1e-320",
    "NaN",
    "inf",
    "-inf",
    "18446744073709551616",
    "4294967295",
    "(",
    ")",
    "[",
    "]",
    "()",
    "[]",
    "\"",
    ",",
    ",,",
    ":",
    "\n",
    "\r",
    "None",
    "Some(",
    "r#\"",
    "/*",
    "\u{feff}",
];

/// One of the valid inputs with one to six changes.
pub(super) fn mutated(valid: &[Vec<u8>], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = valid[random.random_range(0..valid.len())].clone();
    for _ in 0..random.random_range(1..=6) {
        let at = random.random_range(0..=bytes.len());
        let end = (at + random.random_range(1..=24_usize)).min(bytes.len());
        match random.random_range(0..7_u32) {
            0 if at < bytes.len() => bytes[at] ^= 1 << random.random_range(0..8_u32),
            1 if at < bytes.len() => bytes[at] = random.random(),
            2 => drop(bytes.drain(at..end)),
            3 => {
                let part = bytes[at..end].to_vec();
                let to = random.random_range(0..=bytes.len());
                drop(bytes.splice(to..to, part));
            }
            4 => bytes.truncate(at),
            5 => {
                let word = WORDS[random.random_range(0..WORDS.len())];
                drop(bytes.splice(at..at, word.bytes()));
            }
            _ => number(&mut bytes, at, random),
        }
    }
    bytes
}

/// Puts a word in the place of the next number.
fn number(bytes: &mut Vec<u8>, from: usize, random: &mut ChaCha8Rng) {
    let Some(start) = bytes[from..].iter().position(u8::is_ascii_digit).map(|i| from + i) else {
        return;
    };
    let is_number = |byte: &u8| byte.is_ascii_digit() || b".-+eE".contains(byte);
    let end = bytes[start..].iter().position(|b| !is_number(b)).map_or(bytes.len(), |i| start + i);
    let word = WORDS[random.random_range(0..9)];
    drop(bytes.splice(start..end, word.bytes()));
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn inputs_differ_and_follow_the_seed() {
        let valid = [b"(a: 12.5, b: [1, 2])".to_vec()];
        let made = |seed| {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            (0..200).map(|_| mutated(&valid, &mut random)).collect::<Vec<_>>()
        };
        assert_eq!(made(1), made(1));
        assert_ne!(made(1), made(2));
        let changed = made(1).into_iter().filter(|input| *input != valid[0]).count();
        assert!(changed > 190, "{changed}");
        assert!(mutated(&[vec![]], &mut ChaCha8Rng::seed_from_u64(3)).len() < 200);
    }
}
