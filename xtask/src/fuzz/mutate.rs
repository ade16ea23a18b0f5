//! How an input is changed: by the parts of its form, and as the bytes it is.

use chacha20::ChaCha8Rng;
use rand::RngExt;

use super::bytes::{Form, of_bytes};
use super::{container, parts};

/// Most bytes of a changed input: beyond, it is cut.
const MOST_BYTES: usize = 200_000;

/// One of the valid inputs, or `from`, with one to six changes of its form and of its bytes.
pub(super) fn mutated(
    form: Form,
    valid: &[Vec<u8>],
    from: Option<&Vec<u8>>,
    random: &mut ChaCha8Rng,
) -> Vec<u8> {
    let other = &valid[random.random_range(0..valid.len())];
    let mut bytes = from.unwrap_or(other).clone();
    // a packed input is changed inside, and now and then as the bytes it is
    let packed =
        matches!(form, Form::Zip | Form::Mat | Form::Gzip) && random.random_range(0..4_u32) > 0;
    if packed && let Some(changed) = container::changed_inside(form, &bytes, random) {
        return changed;
    }
    for _ in 0..random.random_range(1..=6) {
        if random.random_range(0..3_u32) == 0 {
            of_bytes(&mut bytes, random);
            continue;
        }
        match form {
            Form::Nested => parts::of_nested(&mut bytes, other, random),
            Form::Table => parts::of_table(&mut bytes, random),
            Form::Fixed => parts::of_fixed(&mut bytes, random),
            Form::Binary | Form::Zip | Form::Mat | Form::Gzip => {
                parts::of_binary(&mut bytes, random);
            }
        }
    }
    bytes.truncate(MOST_BYTES);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    /// In every form: the same seed gives the same inputs, another seed others, and nearly all differ from the valid one.
    #[test]
    fn inputs_differ_and_follow_the_seed() {
        for (form, valid) in [
            (Form::Nested, "(a: 12.5, b: [1, 2], c: \"x, (\", d: Some((e: 1)))"),
            (Form::Table, "time_s,command_V\n0,1\n0.1,2\n0.2,3\n"),
            (Form::Fixed, "  0.1000  0.2000  0.3000\n  1.0000  2.0000  3.0000\n"),
            (Form::Binary, "\u{1}\0\0\0\u{2}\0\0\0abcdefgh"),
        ] {
            let valid = [valid.as_bytes().to_vec()];
            let made = |seed| {
                let mut random = ChaCha8Rng::seed_from_u64(seed);
                (0..200).map(|_| mutated(form, &valid, None, &mut random)).collect::<Vec<_>>()
            };
            assert_eq!(made(1), made(1));
            assert_ne!(made(1), made(2));
            let changed = made(1).into_iter().filter(|input| *input != valid[0]).count();
            assert!(changed > 170, "{form:?}: {changed}");
            let mut random = ChaCha8Rng::seed_from_u64(3);
            for _ in 0..100 {
                assert!(mutated(form, &[vec![]], None, &mut random).len() < 400);
            }
        }
    }
}
