//! Text tables as people have them, damaged ones, and ones that are too long to be kept.

use super::*;
use proptest::prelude::*;
use std::io::Read;

const REDUCTION: Reduction =
    Reduction { most_samples: 1024, reduce_to_hz: None, sampling_hz: None, split: false };

fn options(columns: &str) -> ColumnOptions {
    let columns = (!columns.is_empty()).then(|| columns.to_owned());
    ColumnOptions { columns, ..ColumnOptions::default() }
}

fn read(text: &str, columns: &str) -> Result<Table, Problems> {
    read_with(Cursor::new(text.to_owned()), &options(columns), REDUCTION)
}

fn read_with(
    reader: impl BufRead + 'static,
    options: &ColumnOptions,
    reduction: Reduction,
) -> Result<Table, Problems> {
    read_csv(Opened::open(reader, "r.csv")?, "r.csv", options, Reading::Folder(None), reduction)
}

fn error(text: &str, columns: &str) -> String {
    read(text, columns).err().unwrap().to_string()
}

#[test]
fn separators_headers_and_units() {
    let rows = [[0.0, 0.001, 0.002], [1.0, 2.0, 3.0], [10.0, 20.0, 40.0]];
    for (text, columns) in [
        ("time_s,u_V,x_um\n0,1,10\n0.001,2,20\n0.002,3,40\n", ""),
        ("# bench\nTime [ms]; u [V]; x [µm]\n0;1;10\n1;2;20\n2;3;40\n", ""),
        ("time\tu\tx\n(ms)\t(V)\t(um)\n0\t1\t10\n1\t2\t20\n2\t3\t40", ""),
        ("0 1 10\n1 2 20\n2 3 40\n", "time_ms,u_V,x_um"),
        ("\u{feff},10,1,0\r\n,20,2,0.001\r\n,40,3,0.002\r\n", "-,x_um,u_V,time_s"),
        (
            "\"time (s)\",\"u (V)\",x_um,\"a, b\"\r\n#\r\n0,1,10,\"c, d\"\r\n0.001,2,20,e\r\n0.002,3,40,f\r\n",
            "",
        ),
        (
            "t,volts,travel,spare\n0,1,10,a\n0.001,2,20,b\n0.002,3,40,c\n",
            "time_s=t,u_V=volts,x_um=#3",
        ),
    ] {
        let mut options = options(columns);
        options.input = Some("u".into());
        let table = read_with(Cursor::new(text), &options, REDUCTION).unwrap();
        assert_eq!(table.choice.labels(), ["time_s", "u_V", "x_um"], "{text}");
        assert_eq!(table.parts[0].columns, rows[1..], "{text}");
        for (found, expected) in table.parts[0].time_s.iter().zip(rows[0]) {
            assert!((found - expected).abs() < 1e-15, "{text}");
        }
    }
}

/// A header of units in which the time alone has its name: no name is lost, and the option printed holds the time.
#[test]
fn the_time_may_have_its_name_beside_units_alone() {
    let rows = "\n0,1,10\n0.001,2,20\n0.002,3,40\n";
    for head in ["time_s,V,um", "time_s,volts,micron", "Time [s],V,um"] {
        let table = read(&format!("{head}{rows}"), "").unwrap();
        assert_eq!(table.choice.labels(), ["time_s", "command_V", "displacement_um"], "{head}");
    }
    for head in ["t,V,um", "time,volt,mm"] {
        let said = error(&format!("{head}{rows}"), "");
        let name = head.split(',').next().unwrap();
        let option = format!("time_s={name}");
        assert!(said.contains(&option), "{head}: {said}");
    }
}

#[test]
fn a_file_without_time_needs_a_frequency() {
    let text = "u_V,x_um\n1,2\n2,3\n3,5\n";
    assert!(
        error(text, "").contains(
            "r.csv:1:1: there is no time column; name one `time_s`, or give --sampling-hz"
        )
    );
    let reduction = Reduction { sampling_hz: Some(50.0), ..REDUCTION };
    let table = read_with(Cursor::new(text), &options(""), reduction).unwrap();
    assert_eq!(table.parts[0].time_s, [0.0, 0.02, 0.04]);
    assert!(error("t,u_V,x_um\n1,2,3\n", "").contains("the column `t` has no known unit"));
}

#[test]
fn bad_rows_are_named() {
    let good = "time_s,u_V,x_um\n0,1,10\n1,2,20\n2,3,40\n3,3,41\n";
    let changed = |from: &str, to: &str| error(&good.replacen(from, to, 1), "");
    assert!(changed("1,2,20", "1,2").contains("r.csv:3:1: the row has 2 fields, the header has 3"));
    assert!(read(&good.replacen("1,2,20", "1,NaN,20", 1), "").is_ok());
    assert!(
        changed("1,2,20", "1,2,2O").contains("r.csv:3:5: displacement_um: `2O` is not a number")
    );
    assert!(changed("2,3,40", "0.5,3,40").contains("r.csv:4:1: time_s: time 0.5 s follows 1 s"));
    assert!(changed("3,3,41", "9,3,41").contains("r.csv:5:1: time_s: the time step is 7 s"));
    assert!(error("time_s,u_V,x_um\n0,1,10\n", "").contains("has 1 rows of numbers"));
    assert!(error("", "").contains("has 0 rows of numbers"));
    assert!(error("0,1\n1,2\n2,3\n", "").contains("the 2 columns have no names"));
    let fixed = "time_s,u_V,x_um\n0.0,1.0,10.0\n1.0,2.0,20.0\n2.0,3.0,40.0\n3.0,3.0,41.5";
    assert!(read(fixed, "").is_ok());
    for cut in 1..11 {
        let text = error(&fixed[..fixed.len() - cut], "");
        assert!(text.contains("r.csv:5:1: the last line is cut off"), "{cut}: {text}");
    }
    let swapped = error("time_s,u_V,x_um\n1,0,10\n2,1,20\n1,2,40\n2,3,41\n", "");
    assert!(
        swapped.contains("time_s: does not increase, but `command_V` increases in equal steps"),
        "{swapped}"
    );
    let latin = &b"time_s,u_V,x_um\n0,1,\xff\n"[..];
    let text = read_with(latin, &options(""), REDUCTION).err().unwrap().to_string();
    assert!(text.contains("r.csv:2:5: displacement_um: `\u{ff}` is not a number"), "{text}");
}

/// What could be read in two ways is read in one that is right, or not at all.
#[test]
fn readings_that_could_be_wrong() {
    let numbers = |text: &str| {
        read(text, "")
            .map(|table| (table.choice.labels().join(" "), table.parts[0].columns.clone()))
    };
    let bench = "time_s command_V displacement_um";
    // three decimals behind a comma are no thousands
    let text =
        "t [ms]\tu [V]\tx [um]\n0\t70,123\t123,456\n1\t71,123\t124,456\n2\t72,123\t126,456\n";
    let (labels, columns) = numbers(text).unwrap();
    assert_eq!((labels.as_str(), columns[0][0], columns[1][2]), (bench, 70.123, 126.456));
    // decimal commas in quotes where commas separate
    let text = "t [s],u [V],x [um]\n\"0,0\",\"1,5\",\"2,5\"\n\"0,1\",\"2,5\",\"3,5\"\n\"0,2\",\"3,5\",\"5,5\"\n";
    assert_eq!(numbers(text).unwrap().1, [[1.5, 2.5, 3.5], [2.5, 3.5, 5.5]]);
    // thousands in quotes are no decimals
    let text = "t [s],u [V],x [um]\n0.1,1.5,\"1,234\"\n0.2,2.5,\"1,250\"\n0.3,3.5,\"1,300\"\n";
    assert!(numbers(text).is_err(), "{:?}", numbers(text));
    // an exponent does not make a comma one of thousands
    let text = "t [s];u [V];x [um]\n5,000E-03;5,000E-01;1,250E+00\n1,000E-02;6,000E-01;1,260E+00\n1,500E-02;7,000E-01;1,280E+00\n";
    assert_eq!(numbers(text).unwrap().1, [[0.5, 0.6, 0.7], [1.25, 1.26, 1.28]]);
    // samples that were lost are no clock that rounds: filled in their places, or refused where steps are not sure to be equal
    let row = |k: usize| format!("{};{};{}\n", 5 * k, k % 7, k % 11);
    let without = |gone: [usize; 2]| {
        let lost: String = (0..105).filter(|k| !gone.contains(k)).map(row).collect();
        numbers(&format!("t [ms];u [V];x [um]\n{lost}"))
    };
    let columns = without([40, 70]).unwrap().1;
    assert_eq!((columns[0].len(), columns[0][40], columns[1][70]), (105, 5.0, 4.0));
    assert!(without([4, 70]).is_err());
    // a slower column is not made up by straight lines
    let slow = |k: usize| if k.is_multiple_of(10) { (k % 11).to_string() } else { String::new() };
    let row = |k: usize| format!("{k};{};{}\n", k % 7, slow(k));
    let rows: String = (0..205).map(row).collect();
    let said = error(&format!("t [ms];u [V];x [um]\n{rows}"), "");
    assert!(said.contains("more than 5 %"), "{said}");
    // a missing value in front is no comment: no sample may vanish
    let rows = "1;2\n2;3\n#N/A;3\n4;5\n5;4\n";
    let text = format!("Sample rate: 10 Hz\nu [V];x [um]\n{rows}");
    assert_eq!(numbers(&text).unwrap().1[0], [1.0, 2.0, 3.0, 4.0, 5.0]);
    // a quotient is a unit, not its last letter
    let text = "speed m/s;u [V];x [um]\n0;1;2\n1;2;3\n2;3;5\n";
    assert!(error(text, "").contains("`speed m/s` has no known unit"), "{}", error(text, ""));
    // several clocks, of which one is not even
    let text = "t1 [s];u [V];t2 [s];x [um]\n0;1;0;2\n1;2;1.5;3\n2;3;3;5\n";
    assert!(error(text, "").contains("there is no time column"), "{}", error(text, ""));
    // a clock of seconds under a faster recorder
    let text = "Time;u [V];x [um]\n10:00:00;1;2\n10:00:00;2;3\n10:00:00;3;5\n10:00:00;4;6\n";
    let said = error(text, "");
    let (remedy, reduction) = ("command_V=#2,displacement_um=#3", Some(50.0));
    assert!(said.contains(&format!("--columns {remedy} --sampling-hz HZ")), "{said}");
    let reduction = Reduction { sampling_hz: reduction, ..REDUCTION };
    assert!(read_with(Cursor::new(text), &options(remedy), reduction).is_ok());
    // a broken first row is a row
    let text = "t [s],u [V],x [um]\n0,abc,1\n1,2,3\n2,3,5\n3,4,6\n";
    assert!(error(text, "").contains("r.csv:2:3: command_V: `abc`"), "{}", error(text, ""));
    // a header that stands twice
    let text =
        "time_s,u_V,x_um\n0,1,2\n1,2,3\n2,3,5\ntime_s,u_V,x_um\n3,4,5\n4,5,6\n5,6,7\n6,7,9\n";
    assert!(error(text, "").contains("`time_s` is not a number"), "{}", error(text, ""));
}

/// Without a time the number of a row is its time: no row may vanish.
#[test]
fn rows_that_are_missing_move_no_later_sample() {
    let wave = |k: usize| (10 * k * k) % 97;
    let table = |row: &dyn Fn(usize) -> String| -> String { (0..60).map(row).collect() };
    let at_rate = |text: &str, columns: &str, split: bool| {
        let reduction = Reduction { sampling_hz: Some(100.0), split, ..REDUCTION };
        read_with(Cursor::new(text.to_owned()), &options(columns), reduction)
            .map(|table| table.parts)
            .map_err(|problems| problems.to_string())
    };
    let full = |k: usize| format!("{};{}\n", wave(k), 2 * wave(k));
    let truth = at_rate(&format!("u [V];x [um]\n{}", table(&full)), "", false).unwrap();
    // three rows of blank cells are filled and counted
    let blank = |k: usize| if (20..23).contains(&k) { ";\n".to_owned() } else { full(k) };
    let found = at_rate(&format!("u [V];x [um]\n{}", table(&blank)), "", false).unwrap();
    assert_eq!(found[0].columns[0][23..], truth[0].columns[0][23..]);
    assert_eq!((found[0].count, found[0].time_s.len()), (60, 60));
    let said = found[0].warnings[0].to_string();
    assert!(said.contains("3 samples without a number are filled by straight lines"), "{said}");
    // eleven are more than that
    let blank = |k: usize| if (20..31).contains(&k) { ";\n".to_owned() } else { full(k) };
    let text = format!("u [V];x [um]\n{}", table(&blank));
    let said = at_rate(&text, "", false).unwrap_err();
    assert!(said.contains("r.csv:33:1: 11 samples before") && said.contains("--split"), "{said}");
    assert_eq!(at_rate(&text, "", true).unwrap().len(), 2);
    // an empty line says nothing: refused, and parted as the remedy says
    for line in ["\n", "  \r\n"] {
        let empty = |k: usize| if k == 30 { line.to_owned() + &full(k) } else { full(k) };
        let text = format!("u [V];x [um]\n{}", table(&empty));
        let said = at_rate(&text, "", false).unwrap_err();
        assert!(said.contains("r.csv:33:1: 1 blank lines or comments before this row"), "{said}");
        let parts = at_rate(&text, "", true).unwrap();
        assert_eq!(parts.iter().map(|part| part.count).collect::<Vec<_>>(), [30, 30]);
    }
    // an empty line behind every row is a habit, and one in a table with a time is harmless
    let double = |k: usize| full(k) + "\n";
    let found = at_rate(&format!("u [V];x [um]\n{}", table(&double)), "", false).unwrap();
    assert_eq!(found[0].columns, truth[0].columns);
    let timed = |k: usize| format!("{k};{}{}", full(k), if k == 30 { "\n" } else { "" });
    let text = format!("t [ms];u [V];x [um]\n{}", table(&timed));
    assert_eq!(read(&text, "").unwrap().parts[0].columns, truth[0].columns);
    // rows that their numbers miss
    let numbered = |k: usize| match k {
        20..23 => String::new(),
        _ => format!("{};{}", k + 1, full(k)),
    };
    let text = format!("n;u [V];x [um]\n{}", table(&numbered));
    let found = at_rate(&text, "", false).unwrap();
    assert_eq!(found[0].columns[0][23..], truth[0].columns[0][23..]);
    // and those of a recorder that keeps every tenth
    let tenth = |k: usize| match k {
        20..23 => String::new(),
        _ => format!("{};{}", 10 * k, full(k)),
    };
    let by_ten = at_rate(&format!("n;u [V];x [um]\n{}", table(&tenth)), "", false).unwrap();
    assert_eq!(by_ten[0].columns, found[0].columns);
    // a line that became a comment was a row
    let comment = |k: usize| if k == 30 { format!("#{}", full(k)) } else { full(k) };
    let commented = format!("u [V];x [um]\n{}", table(&comment));
    let said = at_rate(&commented, "", false).unwrap_err();
    assert!(said.contains("r.csv:33:1: 1 blank lines or comments before this row"), "{said}");
    // unless the user leaves them out
    assert_eq!(at_rate(&text, "-,u_V,x_um", false).unwrap()[0].count, 57);
    // numbers that begin again, at the end of a counter or in another record
    let byte = |k: usize| format!("{};{}", (k + 230) % 256, full(k));
    let text = format!("n;u [V];x [um]\n{}", table(&byte));
    assert_eq!(at_rate(&text, "", false).unwrap()[0].columns, truth[0].columns);
    let again = |k: usize| format!("{};{}", k % 30, full(k));
    let text = format!("n;u [V];x [um]\n{}", table(&again));
    let said = at_rate(&text, "", false).unwrap_err();
    assert!(said.contains("the numbers of the rows go from 29 to 0"), "{said}");
    assert_eq!(at_rate(&text, "", true).unwrap().len(), 2);
}

/// A text table that is made while it is read: `rows` rows, 1 kHz.
struct Endless {
    rows: usize,
    next: usize,
    buffer: Vec<u8>,
    at: usize,
}

impl Read for Endless {
    fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
        let available = self.fill_buf()?;
        let count = available.len().min(out.len());
        out[..count].copy_from_slice(&available[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Endless {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        if self.at == self.buffer.len() {
            self.buffer.clear();
            self.at = 0;
            for _ in 0..500.min(self.rows - self.next) {
                let (i, x) = (self.next, self.next % 1000);
                self.buffer.extend(format!("{}.{:03},{x},{}\n", i / 1000, i % 1000, 2 * x).bytes());
                self.next += 1;
            }
        }
        Ok(&self.buffer[self.at..])
    }

    fn consume(&mut self, count: usize) {
        self.at += count;
    }
}

/// However long the table, no more than `most_samples` of it are kept, and they are its means.
#[test]
fn a_million_rows_stream_through() {
    let rows = 1_000_000;
    let reader = Endless { rows, next: 0, buffer: vec![], at: 0 };
    let table = read_with(reader, &options("time_s,u_V,x_um"), REDUCTION).unwrap();
    let found = &table.parts[0];
    assert_eq!((found.count, found.block), (rows, 1024));
    assert_eq!(found.time_s.len(), rows / 1024);
    for (block, u) in found.columns[0].iter().enumerate() {
        let mean =
            (1024 * block..1024 * (block + 1)).map(|i| (i % 1000) as f64).sum::<f64>() / 1024.0;
        assert!((u - mean).abs() < 1e-9, "{block}");
        assert!((found.columns[1][block] - 2.0 * u).abs() < 1e-9);
    }
    for column in &found.columns {
        assert!(column.capacity() <= 2 * 1024, "{}", column.capacity());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_tables_never_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in any::<prop::sample::Index>(),
    ) {
        let mut bytes = b"time_s,u_V,x_um\n0.0,1,10\n0.1,2,20\n0.2,3,40\n0.3,3,41\n".to_vec();
        for (index, byte) in changes {
            let at = index.index(bytes.len());
            bytes[at] = byte;
        }
        bytes.truncate(cut.index(bytes.len()) + 1);
        for columns in ["", "time_s,u_V,x_um", "-,time_s=#1"] {
            let _ = read_with(Cursor::new(bytes.clone()), &options(columns), REDUCTION);
        }
    }
}

/// A clock runs through midnight, and a row that stands twice is one sample: both without a question.
#[test]
fn midnight_and_doubled_rows_are_no_faults() {
    let row = |k: usize| format!("{:.2},{},{}\n", 0.01 * k as f64, k % 7, k % 11);
    let twice = |k: usize| row(k).repeat(if [50, 90].contains(&k) { 2 } else { 1 });
    let rows: String = (0..120).map(twice).collect();
    let table = read(&format!("t [s],u [V],x [um]\n{rows}"), "").unwrap();
    let part = &table.parts[0];
    assert_eq!((part.columns[0].len(), part.columns[0][60]), (120, 4.0));
    let said = part.warnings.iter().map(ToString::to_string).collect::<String>();
    assert!(said.contains("2 rows that repeat"), "{said}");
    let clock = |k: usize| {
        let hundredths = (86_399 * 100 + k) % (86_400 * 100);
        let [h, m] = [hundredths / 360_000, hundredths / 6000 % 60];
        format!("{h:02}:{m:02}:{:05.2},{},{}\n", (hundredths % 6000) as f64 / 100.0, k % 7, k % 11)
    };
    let rows: String = (0..300).map(clock).collect();
    let part = &read(&format!("Time,u [V],x [um]\n{rows}"), "").unwrap().parts[0];
    assert_eq!(part.columns[0].len(), 300);
    assert!((part.sampling.step_s - 0.01).abs() < 1e-9, "{:?}", part.sampling);
    // behind a gap a record may begin in mid-motion; where the time begins again it is another one
    let split = Reduction { split: true, ..REDUCTION };
    let parted = |second: &dyn Fn(usize) -> usize| {
        let row = |k: usize| format!("{},{},{}\n", second(k), k % 7, k % 11);
        let rows: String = (0..120).map(row).collect();
        let text = format!("t [s],u [V],x [um]\n{rows}");
        let table = read_with(Cursor::new(text), &options(""), split).unwrap();
        let warned = |part: &crate::import::gather::Gathered| {
            part.warnings.iter().any(|w| w.to_string().contains("gap"))
        };
        table.parts.iter().map(warned).collect::<Vec<_>>()
    };
    assert_eq!(parted(&|k| k + 500 * (k / 60)), [false, true]);
    assert_eq!(parted(&|k| k % 60), [false, false]);
}
