//! The speed page of the book.

use std::fmt::Write as _;

use super::commands::{BARE, CASE, Spent, Timed, Timing, WAKE};
use super::growth::{Power, Series};
use super::machine::Machine;
use super::paths::{KERNEL, LINE_INDUCTION, MACHINE, MeasuredPath, RESIDUAL, element_s};
use super::samples::Samples;
use crate::XtaskError;
use crate::validate::figure;

/// Everything that was measured; empty where a part was left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// What it was measured on.
    pub machine: Machine,
    /// The earlier commit whose commands were timed beside, if there was one.
    pub before: Option<String>,
    /// The benches.
    pub samples: Samples,
    /// The paths.
    pub paths: Vec<MeasuredPath>,
    /// How times grow.
    pub growth: Vec<Series>,
    /// Whole commands.
    pub commands: Vec<Timed>,
}

const INTRODUCTION: &str = "\
# Speed

<!-- Written by `cargo xtask bench`; do not edit. -->

Every figure but those of before is of one run of `cargo xtask bench`, in release builds. A time is the least of several: other
work on the machine interrupts some of them, not all. A bar is what was asked for, of trims for two cores; what is over it is
bold. Beside times of before stands how many times those of now they are.
";

const LIMITS: &str = "
## Hot paths

What one core can do at most, measured with independent operations in its vector unit:
";

const PATHS: &str = "
Divisions and roots keep the divider busy, sums and products the multiply-add units. The longer of the two times is the limit of
a path. It holds for full vectors in which nothing waits. Operations are counted in the formulas that the
program uses. What is made of many residuals of a revolution is given in these. Times of before were noted on an older
processor (Zen 3).
";

const COMMANDS: &str = "
## Whole commands

Bars are for two cores by the clock, but where processor seconds are said.
";

const GROWTH: &str = "
## Growth

`time = factor size^exponent`, by least squares on logarithms. Benches run on one core, commands on one and on two,
by the clock. A constant part makes an exponent smaller than the last sizes have.
";

const NOW: &str = "
*Now*, a trim in the free wake on one core. Calls were counted by probes in a copy of commit `5c6c87b`: 37 responses, before
the wake and in it, with 218 orbits and one Newton matrix.
";

/// Where identification and diagnosis spend their time.
const BENCH: &str = "
Identification of the shipped set and the diagnosis of the table above, one thread, sampled 300 and 500 times a second at commit
`9c9412e1`. Shares of the processor time:

| part | identification | diagnosis |
|---|---|---|
| hysteresis laws | 19 % | below 1 % |
| stages behind them: creep, lags | 9 % | 3 % |
| quadratic program of the densities | 17 % | below 1 % |
| steps of Levenberg and Marquardt | 9 % | none |
| other dense algebra | 14 % | 9 % |
| plays, equations and evidence of the causes | none | 52 % |
| memory and system | 10 % | 11 % |
| the rest, loops that the compiler has joined | 22 % | 24 % |
";

/// Said where the machine was not idle.
const BUSY: &str = "
**Other programs shared the cores of this run: times are too long, by the clock most of all. Only ratios within it mean something.**
";

/// The page.
///
/// # Errors
/// [`XtaskError::Speed`] for a bench that was not run, and for a series without a power.
pub fn render(figures: &Figures) -> Result<String, XtaskError> {
    let Figures { machine, before, samples, paths, growth, commands } = figures;
    let mut page = INTRODUCTION.to_owned();
    let Machine { processor, cores, load, compiler, day, commit } = machine;
    let _ = writeln!(
        page,
        "\n{day}, commit {commit}. {processor}, {cores} cores, load at the start {load}. {compiler}."
    );
    if machine.is_busy() {
        page += BUSY;
    }
    if !paths.is_empty() {
        page += LIMITS;
        page += &limit_table(samples)?;
        page += PATHS;
        page += &path_table(paths);
        page += &kernel_rates(paths)?;
    }
    if !commands.is_empty() {
        page += COMMANDS;
        page += &before.as_ref().map_or_else(
            || "Times of before were noted on an older processor (Zen 3).\n".to_owned(),
            |commit| {
                format!("Times of before are those of commit {commit}, on the same machine in the same run.\n")
            },
        );
        page += &command_table(commands, element_s(samples, RESIDUAL).ok());
    }
    if !growth.is_empty() {
        page += GROWTH;
        page += &growth_table(growth)?;
    }
    if !(paths.is_empty() || commands.is_empty() || growth.is_empty()) {
        let _ = write!(page, "\n## Where each second went\n\n{}", include_str!("before.md"));
        page += &now(samples, commands)?;
    }
    Ok(page)
}

/// A table from its titles and rows.
fn table<const N: usize>(titles: [&str; N], rows: impl IntoIterator<Item = [String; N]>) -> String {
    let mut text = format!("\n| {} |\n|{}\n", titles.join(" | "), "---|".repeat(N));
    for row in rows {
        let _ = writeln!(text, "| {} |", row.join(" | "));
    }
    text
}

fn limit_table(samples: &Samples) -> Result<String, XtaskError> {
    let rows = MACHINE.1.map(|id| {
        let name = id.trim_start_matches("machine/").to_owned();
        let element_s = element_s(samples, id)?;
        Ok([name, duration(element_s), figure(1.0 / element_s)])
    });
    let rows = rows.into_iter().collect::<Result<Vec<_>, XtaskError>>()?;
    Ok(table(["operation", "each", "per second"], rows))
}

fn path_table(paths: &[MeasuredPath]) -> String {
    let nothing = || "–".to_owned();
    let rows = paths.iter().map(|measured| {
        let MeasuredPath { path, bar_s, time_s, limits, residuals } = *measured;
        let limit = |of: fn(&super::paths::Limits) -> f64| {
            limits.as_ref().map(of).filter(|s| *s > 0.0).map_or_else(nothing, duration)
        };
        [
            path.name.to_owned(),
            path.before.map_or_else(nothing, |before| before.over(time_s, duration)),
            bar_s.map_or_else(nothing, duration),
            duration(time_s),
            bar_s.map_or_else(nothing, |bar_s| met(time_s / bar_s)),
            limit(|l| l.divider_s),
            limit(|l| l.multiply_add_s),
            limits.map_or_else(nothing, |l| figure(time_s / l.longest_s())),
            if path.id != RESIDUAL && residuals >= 1.0 { figure(residuals) } else { nothing() },
        ]
    });
    let titles = [
        "path",
        "before",
        "bar",
        "measured",
        "over bar",
        "limit of the divider",
        "of multiply-adds",
        "over the longer limit",
        "in residuals",
    ];
    table(titles, rows)
}

/// Evaluations of the kernel in a second, and how many the processor allows.
fn kernel_rates(paths: &[MeasuredPath]) -> Result<String, XtaskError> {
    let of = |id: &str| {
        paths.iter().find(|measured| measured.path.id == id).ok_or_else(|| XtaskError::Speed {
            what: id.to_owned(),
            said: "the kernel was not measured".to_owned(),
        })
    };
    let [one, two] = KERNEL.map(of);
    let (one, two) = (one?, two?);
    let allowed = one.limits.map_or_else(String::new, |limits| {
        let [divider, products] =
            [limits.divider_s, limits.multiply_add_s].map(|s| figure(1.0 / s));
        format!("; the divider of a core allows {divider}, its multiply-adds {products}")
    });
    let [one, two] = [one, two].map(|measured| figure(1.0 / measured.time_s));
    Ok(format!("\nEvaluations of the kernel a second: {one} on one core, {two} on two{allowed}.\n"))
}

fn command_table(commands: &[Timed], residual_s: Option<f64>) -> String {
    let rows = commands.iter().map(|timed| {
        let Timing { name, arguments, bar_s, .. } = timed.timing;
        let cell = |value: Option<f64>| value.map_or("–".to_owned(), figure);
        let one = |part: fn(Spent) -> f64| cell(timed.one.map(part));
        [
            format!("{name}: `{}`", format!("hhc {arguments}").trim_end()),
            cell(bar_s) + if timed.timing.bar_is_cpu { " of processors" } else { "" },
            timed.before().map_or("–".to_owned(), |b| b.over(timed.held_s(), figure)),
            figure(timed.cpu_s()),
            bar_s.map_or("–".to_owned(), |bar_s| met(timed.held_s() / bar_s)),
            one(|spent| spent.wall_s),
            figure(timed.two.wall_s),
            figure(timed.two.cpu_s),
            cell(residual_s.filter(|_| timed.timing.is_of_rotor).map(|s| timed.cpu_s() / s)),
        ]
    });
    let titles = [
        "command",
        "bar, s",
        "before, s",
        "processor, s",
        "over bar",
        "wall, one thread, s",
        "wall, two threads, s",
        "processor, two threads, s",
        "in residuals of a revolution",
    ];
    table(titles, rows)
}

fn growth_table(growth: &[Series]) -> Result<String, XtaskError> {
    let row = |series: &Series| {
        let fit = Power::fit(&series.points).ok_or_else(|| XtaskError::Speed {
            what: series.name.clone(),
            said: format!("no power goes through {:?}", series.points),
        })?;
        let points = series.points.iter();
        let points =
            points.map(|(size, time_s)| format!("{}: {}", figure(*size), duration(*time_s)));
        Ok([
            series.name.clone(),
            points.collect::<Vec<_>>().join(", "),
            format!("{:.2}", fit.exponent),
            duration(fit.factor),
            format!("{} %", figure(100.0 * fit.deviation)),
        ])
    };
    let rows = growth.iter().map(row).collect::<Result<Vec<_>, XtaskError>>()?;
    Ok(table(["what over what", "size: time", "exponent", "factor", "farthest from the fit"], rows))
}

/// What the parts of a trim and of the study take now.
fn now(samples: &Samples, commands: &[Timed]) -> Result<String, XtaskError> {
    let parts = [
        ("residual of a revolution", RESIDUAL, "478"),
        ("sweep of the wake, 36 azimuths", "sweep over azimuths/36", "20, at 12 and 36 azimuths"),
        (
            "what the lines of a wake held still induce, 36 azimuths",
            LINE_INDUCTION.1,
            "6, at 12 and 36 azimuths",
        ),
        ("the whole trim", "trim in the free wake/1", "1"),
    ];
    let each = parts.map(|(name, id, calls)| {
        Ok([name.to_owned(), duration(element_s(samples, id)?), calls.to_owned()])
    });
    let each = each.into_iter().collect::<Result<Vec<_>, XtaskError>>()?;
    let mut text = NOW.to_owned();
    text += &table(["part", "each", "calls"], each);
    let cpu_s = |timing: &Timing| {
        let found = commands.iter().find(|timed| timed.timing.name == timing.name);
        found.map(Timed::cpu_s).ok_or_else(|| XtaskError::Speed {
            what: timing.name.to_owned(),
            said: "it was not timed".to_owned(),
        })
    };
    let [trim_s, case_s, all_s] = [cpu_s(&WAKE)?, cpu_s(&CASE)?, cpu_s(&BARE)?];
    text += "\nBare `hhc` now, as differences of commands:\n";
    let rows = [
        ("trim in the free wake", trim_s),
        ("actuator, T and control of nine sets", case_s - trim_s),
        ("table of assumptions", all_s - case_s),
    ];
    let rows =
        rows.map(|(name, s)| [name.to_owned(), figure(s), format!("{:.0} %", 100.0 * s / all_s)]);
    text += &table(["part", "processor, s", "share"], rows);
    text += BENCH;
    Ok(text)
}

/// A time over its bar; in bold where it is longer.
fn met(ratio: f64) -> String {
    if ratio <= 1.0 { figure(ratio) } else { format!("**{}**", figure(ratio)) }
}

/// A time with three digits in a unit that suits it.
fn duration(seconds: f64) -> String {
    let units = [(1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns"), (1e-12, "ps")];
    let fits = |unit: &&(f64, &str)| seconds >= 0.9995 * unit.0;
    let (unit, name) = units.iter().find(fits).copied().unwrap_or((1e-12, "ps"));
    format!("{} {name}", figure(seconds / unit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::commands::TIMINGS;
    use crate::bench::paths::{self, PATHS};
    use crate::bench::samples::Sample;

    /// Commands of 3, 6, 9 ... processor seconds, and a series that grows with the square.
    fn figures() -> Figures {
        let mut samples = paths::tests::samples();
        samples
            .insert("sweep over azimuths/36".to_owned(), Sample { call_s: 0.024, elements: 1.0 });
        let text = str::to_owned;
        let machine = Machine {
            processor: text("a processor"),
            cores: 2,
            load: text("0.1"),
            compiler: text("a compiler"),
            day: text("a day"),
            commit: text("a commit"),
        };
        let timed = TIMINGS.iter().zip(1..).map(|(timing, n)| {
            let two = Spent { wall_s: 2.0 * f64::from(n), cpu_s: 3.0 * f64::from(n) };
            Timed { timing: *timing, one: (!timing.slow).then_some(two), two, earlier: None }
        });
        let square = Series { name: text("squares"), points: vec![(2.0, 4e-3), (6.0, 36e-3)] };
        let paths = paths::measured(&samples).unwrap();
        let growth = vec![square];
        Figures { machine, before: None, samples, paths, growth, commands: timed.collect() }
    }

    /// The cells of the row that begins with a text.
    fn row<'a>(page: &'a str, begin: &str) -> Vec<&'a str> {
        let line = page.lines().find(|line| line.starts_with(&format!("| {begin}")));
        line.unwrap_or_default().trim_matches('|').split('|').map(str::trim).collect()
    }

    #[test]
    fn a_whole_page_has_every_path_command_and_series() {
        let page = render(&figures()).unwrap();
        for path in &PATHS {
            assert_eq!(row(&page, path.name).len(), 9, "{}", path.name);
        }
        for timing in &TIMINGS {
            assert_eq!(row(&page, timing.name).len(), 9, "{}", timing.name);
        }
        assert_eq!(row(&page, "squares")[1..4], ["2: 4 ms, 6: 36 ms", "2.00", "1 ms"]);
        // 1 ms in place of 0.8 ms is too long, in place of 50 ms it is not
        assert_eq!(row(&page, "residual of a revolution")[2..5], ["800 us", "1 ms", "**1.25**"]);
        assert_eq!(row(&page, "response from")[4], "0.02");
        // 2.2 to 2.5 ms before, 1 ms now; 41 s before, 8 s by the clock now
        let before = row(&page, "residual of a revolution")[1];
        assert_eq!(before, "2.2 ms to 2.5 ms: 2.2 to 2.5 times");
        let before = row(&page, "the paper's study, bare `hhc`")[2];
        assert_eq!(before, "41, its table in Drees's inflow: 5.1 times");
        // a division of 1 ns, two roots of 2 ns, 29 multiply-adds of 0.05 ns
        assert_eq!(row(&page, "kernel, an evaluation, one")[5..7], ["5 ns", "1.45 ns"]);
        // bare `hhc` is the fourth, the case the second, the trim the first
        assert_eq!(row(&page, "table of assumptions"), ["table of assumptions", "6", "50 %"]);
        assert!(page.lines().all(|line| line.len() <= 300));
    }

    #[test]
    fn a_busy_machine_is_told() {
        let with = |load: &str| {
            let own = figures();
            let machine = Machine { load: load.to_owned(), ..own.machine };
            render(&Figures { machine, ..own }).unwrap().contains(BUSY)
        };
        assert_eq!(["0.1", "10.1", "unknown"].map(with), [false, true, false]);
    }

    #[test]
    fn what_was_left_out_has_no_heading() {
        let headings = |figures: &Figures| {
            let page = render(figures).unwrap();
            page.lines()
                .filter(|line| line.starts_with("## "))
                .map(str::to_owned)
                .collect::<Vec<_>>()
        };
        let all = ["## Hot paths", "## Whole commands", "## Growth", "## Where each second went"];
        assert_eq!(headings(&figures()), all);
        assert_eq!(headings(&Figures { commands: Vec::new(), ..figures() }), [all[0], all[2]]);
        assert_eq!(headings(&Figures { paths: Vec::new(), ..figures() }), all[1..3]);
    }

    #[test]
    fn a_series_without_a_power_and_a_command_without_a_time_make_no_page() {
        let one = Series { name: "lonely".to_owned(), points: vec![(2.0, 1.0)] };
        let error = render(&Figures { growth: vec![one], ..figures() }).unwrap_err().to_string();
        assert!(error.contains("lonely"), "{error}");
        let commands = figures().commands.split_off(2);
        let error = render(&Figures { commands, ..figures() }).unwrap_err().to_string();
        assert!(error.contains(WAKE.name), "{error}");
    }

    #[test]
    fn times_have_units_that_suit() {
        for (seconds, text) in [
            (12.34, "12.3 s"),
            (0.9999, "1 s"),
            (0.8e-3, "800 us"),
            (4.8e-9, "4.8 ns"),
            (3e-11, "30 ps"),
        ] {
            assert_eq!(duration(seconds), text);
        }
    }
}
