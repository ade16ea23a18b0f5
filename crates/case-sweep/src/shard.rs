//! The part of a sweep that one process runs, and the script of an array of Slurm.

use crate::SweepError;

/// A part of the cases: every `of`-th in the order of their keys, from the `index`-th on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Number of the part, from 0.
    index: usize,
    /// Number of parts.
    of: usize,
}

impl Shard {
    /// All cases.
    pub const WHOLE: Self = Self { index: 0, of: 1 };

    /// The part `i/n`, from `1/n` to `n/n`.
    ///
    /// # Errors
    /// [`SweepError::Shard`] for anything else.
    pub fn parse(text: &str) -> Result<Self, SweepError> {
        let number = |text: &str| text.parse::<usize>().ok();
        let parts = text.split_once('/').and_then(|(i, n)| Some((number(i)?, number(n)?)));
        match parts {
            Some((i, n)) if 1 <= i && i <= n => Ok(Self { index: i - 1, of: n }),
            _ => Err(SweepError::Shard(format!(
                "--shard: {text} is no part, expected i/n from 1/n to n/n; the first of four is 1/4"
            ))),
        }
    }

    /// The part of a task of a Slurm array, from the values of `SLURM_ARRAY_TASK_ID` and of `_MIN`, `_MAX` and `_COUNT`;
    /// all cases outside an array. The numbers of the tasks follow one another.
    ///
    /// # Errors
    /// [`SweepError::Shard`] for values that are no number, or numbers with gaps.
    pub fn of_array(id: Option<&str>, tasks: [Option<&str>; 3]) -> Result<Self, SweepError> {
        let Some(id) = id else { return Ok(Self::WHOLE) };
        let number = |text: Option<&str>| text.and_then(|text| text.parse::<usize>().ok());
        match (number(Some(id)), tasks.map(number)) {
            (Some(id), [Some(min), Some(max), Some(of)])
                if (min..=max).contains(&id) && max - min + 1 == of =>
            {
                Ok(Self { index: id - min, of })
            }
            _ => {
                let [min, max, count] = tasks.map(|value| value.unwrap_or("missing"));
                Err(SweepError::Shard(format!(
                    "SLURM_ARRAY_TASK_ID is {id}, _MIN {min}, _MAX {max}, _COUNT {count}: expected tasks that follow one another, as --array=0-3 makes them; give --shard i/n instead"
                )))
            }
        }
    }

    /// The items of the part, in the order in which they are given. The order of their keys is by chance: dear values of an
    /// axis fall to all parts, whatever its place among the axes.
    pub fn part<T>(self, items: Vec<T>, key: impl Fn(&T) -> &str) -> Vec<T> {
        let mut order: Vec<usize> = (0..items.len()).collect();
        order.sort_by(|a, b| key(&items[*a]).cmp(key(&items[*b])));
        let mut is_mine = vec![false; items.len()];
        for place in order.into_iter().skip(self.index).step_by(self.of) {
            is_mine[place] = true;
        }
        items.into_iter().zip(is_mine).filter_map(|(item, mine)| mine.then_some(item)).collect()
    }
}

/// A word for a POSIX shell.
fn quoted(word: &str) -> String {
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// The sbatch script of an array of `tasks` tasks, each of which runs `command`, a program with its arguments.
pub fn array_script(name: &str, tasks: usize, cpus_per_task: usize, command: &[String]) -> String {
    let name: String = name.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
    let words: Vec<String> = command.iter().map(|word| quoted(word)).collect();
    let last = tasks.saturating_sub(1);
    format!(
        "#!/bin/sh
#SBATCH --job-name={name}
#SBATCH --array=0-{last}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={cpus_per_task}
# every task runs its part of the cases; what is there already is skipped, so submit again after a failure
export RAYON_NUM_THREADS=\"${{SLURM_CPUS_PER_TASK:-1}}\"
exec {}
",
        words.join(" ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_all_cases_once() {
        let all: Vec<String> = ["g", "c", "a", "e", "b", "f", "d"].map(str::to_owned).to_vec();
        let part = |i: usize| {
            Shard::parse(&format!("{i}/3")).unwrap().part(all.clone(), |key| key.as_str())
        };
        assert_eq!(
            [part(1), part(2), part(3)],
            [vec!["g", "a", "d"], vec!["e", "b"], vec!["c", "f"]]
        );
        for text in ["0/4", "5/4", "1", "a/b", "1/0", "-1/4", ""] {
            assert!(Shard::parse(text).unwrap_err().to_string().contains("1/n to n/n"), "{text}");
        }
    }

    #[test]
    fn a_task_of_an_array_is_a_part() {
        let shard = Shard::of_array(Some("7"), ["5", "8", "4"].map(Some)).unwrap();
        assert_eq!(shard, Shard::parse("3/4").unwrap());
        assert_eq!(Shard::of_array(None, [None; 3]).unwrap(), Shard::WHOLE);
        // the last is --array=3,7
        for (id, tasks) in [
            ("9", ["5", "8", "4"].map(Some)),
            ("7", [None, Some("8"), Some("4")]),
            ("x", [Some("5"), Some("8"), None]),
            ("3", ["3", "7", "2"].map(Some)),
        ] {
            let error = Shard::of_array(Some(id), tasks).unwrap_err().to_string();
            assert!(error.contains("--array=0-3"), "{error}");
        }
    }

    #[test]
    fn the_script_keeps_words_whole() {
        let script = array_script("a b", 4, 2, &["hhc".into(), "it's $HOME".into()]);
        assert!(script.contains("--array=0-3\n") && script.contains("--job-name=a_b\n"));
        assert!(script.ends_with("exec 'hhc' 'it'\\''s $HOME'\n"), "{script}");
    }
}
