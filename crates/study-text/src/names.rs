//! Names of sets of harmonics and of flaps.

/// A set of harmonics as a title: `2` or `2+3`.
pub fn set_name(harmonics: &[usize]) -> String {
    let all: Vec<String> = harmonics.iter().map(usize::to_string).collect();
    all.join("+")
}

/// Name of a flap, counted from 0 at the root.
pub fn flap_name(index: usize) -> String {
    match index {
        0 => "inboard".to_owned(),
        1 => "outboard".to_owned(),
        more => format!("flap {}", more + 1),
    }
}
