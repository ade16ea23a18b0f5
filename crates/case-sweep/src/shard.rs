//! The part of a sweep that one process runs, and the script of an array of Slurm.

use crate::SweepError;

/// A part of the cases: every `of`-th, from the `index`-th on.
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

    /// The part of a task of a Slurm array, from the values of `SLURM_ARRAY_TASK_ID`, `_MIN` and `_COUNT`; all cases
    /// outside an array. The numbers of the tasks follow one another.
    ///
    /// # Errors
    /// [`SweepError::Shard`] for values that are no number, or numbers with gaps.
    pub fn of_array(
        id: Option<&str>,
        min: Option<&str>,
        count: Option<&str>,
    ) -> Result<Self, SweepError> {
        let Some(id) = id else { return Ok(Self::WHOLE) };
        let number = |text: Option<&str>| text.and_then(|text| text.parse::<usize>().ok());
        match (number(Some(id)), number(min), number(count)) {
            (Some(id), Some(min), Some(of)) if id >= min && id - min < of => {
                Ok(Self { index: id - min, of })
            }
            _ => Err(SweepError::Shard(format!(
                "SLURM_ARRAY_TASK_ID is {id}, _MIN {}, _COUNT {}: expected tasks that follow one another, as --array=0-3 makes them; give --shard i/n instead",
                min.unwrap_or("missing"),
                count.unwrap_or("missing")
            ))),
        }
    }

    /// The items of the part.
    pub fn part<T>(self, items: Vec<T>) -> Vec<T> {
        items.into_iter().skip(self.index).step_by(self.of).collect()
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
        let all: Vec<usize> = (0..11).collect();
        let mut found: Vec<usize> = Vec::new();
        for i in 1..=4 {
            found.extend(Shard::parse(&format!("{i}/4")).unwrap().part(all.clone()));
        }
        assert_eq!(found[..3], [0, 4, 8]);
        found.sort_unstable();
        assert_eq!(found, all);
        for text in ["0/4", "5/4", "1", "a/b", "1/0", "-1/4", ""] {
            assert!(Shard::parse(text).unwrap_err().to_string().contains("1/n to n/n"), "{text}");
        }
    }

    #[test]
    fn a_task_of_an_array_is_a_part() {
        let shard = Shard::of_array(Some("7"), Some("5"), Some("4")).unwrap();
        assert_eq!(shard, Shard::parse("3/4").unwrap());
        assert_eq!(Shard::of_array(None, None, None).unwrap(), Shard::WHOLE);
        for (id, min, count) in
            [("9", Some("5"), Some("4")), ("7", None, Some("4")), ("x", Some("5"), None)]
        {
            let error = Shard::of_array(Some(id), min, count).unwrap_err().to_string();
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
