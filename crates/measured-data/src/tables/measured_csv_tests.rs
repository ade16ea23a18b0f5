//! What measured tables are accepted, and what is said about the others.

use super::*;

fn parse(text: &str) -> Result<MeasuredTable, Problems> {
    parse_measured_csv(&Source { name: "r.csv".into(), text: text.into() })
}

fn error(text: &str) -> String {
    parse(text).unwrap_err().to_string()
}

const GOOD: &str = "time_s,command_V,displacement_um\n0.0,1,2\n0.1,1.5,2.5\n0.2,2,3\n";

#[test]
fn three_ways_to_give_units() {
    let a = parse(GOOD).unwrap();
    let b =
        parse(&GOOD.replace(
            "time_s,command_V,displacement_um",
            "time [s], command [V], displacement [µm]",
        ));
    let c = parse(
        &GOOD
            .replace("time_s,command_V,displacement_um", "Time,command,displacement\n(s),(V),(um)"),
    )
    .unwrap();
    assert_eq!(b.unwrap(), a);
    assert_eq!((c.time_s, c.output), (a.time_s.clone(), a.output.clone()));
    assert_eq!(a.lines, [2, 3, 4]);
    assert!((a.time_step_s - 0.1).abs() < 1e-15);
    assert_eq!(a.load_newton, None);
}

#[test]
fn windows_lines_comments_and_further_columns() {
    let text = "# bench of May\r\ntime_s,command_V,displacement_um,load_N,temperature_C\r\n0,1,2,3,20\r\n1,1,2,3,20\r\n2,1,2,3,21\r\n";
    let table = parse(text).unwrap();
    assert_eq!(table.load_newton.unwrap(), [3.0; 3]);
    assert_eq!(table.temperature_celsius.unwrap(), [20.0, 20.0, 21.0]);
    assert_eq!(table.lines, [3, 4, 5]);
}

#[test]
fn a_missing_column_is_named() {
    let text = error("time_s,displacement_um\n0,1\n1,2\n2,3\n");
    assert_eq!(
        text,
        "r.csv:1:1: the column `command_V` is missing, the header has time_s, displacement_um; add the column, or correct its name"
    );
}

#[test]
fn wrong_units_come_with_the_factor() {
    let text = error("time_s,command_mV,displacement_mm\n0,1,1\n1,2,1\n2,3,1\n");
    assert!(text.contains("r.csv:1:8: command_mV: the unit is mV, expected V; multiply the column by 0.001 and name it `command_V`"), "{text}");
    assert!(text.contains("the unit is mm, expected um; multiply the column by 1000"), "{text}");
    let text = error("time_s,command_V,displacement_furlong\n0,1,1\n1,2,1\n2,3,1\n");
    assert!(text.contains("the unit is furlong, expected um; give the column as"), "{text}");
    let text = error("time_s,command,displacement_um\n0,1,1\n1,2,1\n2,3,1\n");
    assert!(text.contains("`command` has no unit; name it `command_V`"), "{text}");
}

#[test]
fn unknown_and_repeated_columns() {
    let text = error("time_s,comand_V,displacement_um\n0,1,1\n1,2,1\n2,3,1\n");
    assert!(text.contains("unknown column `comand_V`, did you mean `command_V`?"), "{text}");
    let text = error("time_s,command_V,command_V,displacement_um\n0,1,1,1\n1,2,1,1\n");
    assert!(text.contains("there twice"), "{text}");
}

#[test]
fn bad_numbers_have_line_and_column() {
    let text = error("time_s,command_V,displacement_um\n0.0,1,2\n0.1, NaN,2.5\n0.2,2,x3\n");
    assert!(text.contains("r.csv:3:6: command_V: the value is NaN, expected a finite"), "{text}");
    assert!(text.contains("r.csv:4:7: displacement_um: `x3` is not a number"), "{text}");
}

#[test]
fn a_number_that_cannot_have_been_measured_is_refused() {
    let text = error("time_s,command_V,displacement_um\n0.0,1,2\n0.1,2,1e300\n0.2,2,3\n");
    assert!(
        text.contains("r.csv:3:7: displacement_um: the value is 1e300, expected no more"),
        "{text}"
    );
}

#[test]
fn many_alike_are_counted() {
    let rows: Vec<String> = (0..20).map(|i| format!("{i},NaN,1")).collect();
    let text = error(&format!("time_s,command_V,displacement_um\n{}\n", rows.join("\n")));
    assert_eq!(text.lines().count(), 7, "{text}");
    assert!(text.contains("r.csv:7:3: command_V: 15 more problems of this kind"), "{text}");
}

#[test]
fn truncated_files_are_recognised() {
    for cut in 1..GOOD.len() - "0.2,2,3\n".len() {
        assert!(parse(&GOOD[..cut]).is_err(), "cut at {cut}");
    }
    let fixed = "time_s,command_V,displacement_um\n0.00,1.00,2.00\n0.10,1.50,2.50\n0.20,2.00,3.00\n0.30,2.00,3.00";
    assert!(parse(fixed).is_ok(), "a last line without line end is no truncation by itself");
    for cut in 1..14 {
        let text = error(&fixed[..fixed.len() - cut]);
        assert!(text.contains("r.csv:5:1: the last line is cut off"), "{cut}: {text}");
    }
}

#[test]
fn time_must_march_evenly() {
    let text = error("time_s,command_V,displacement_um\n0,1,1\n1,2,1\n1,2,1\n2,3,1\n3,3,1\n");
    assert!(
        text.contains("r.csv:4:1: time_s: time 1 s follows 1 s, expected increasing"),
        "{text}"
    );
    let text = error("time_s,command_V,displacement_um\n0,1,1\n1,2,1\n2,2,1\n4,3,1\n");
    assert!(
        text.contains("r.csv:5:1: time_s: the time step is 2 s, the record's is 1 s"),
        "{text}"
    );
}

#[test]
fn no_prefix_or_damage_panics() {
    for byte in 0..GOOD.len() {
        let mut bytes = GOOD.as_bytes().to_vec();
        for replacement in [b',', b'\n', b'x', b'(', b'"', b'-'] {
            bytes[byte] = replacement;
            let _ = parse(std::str::from_utf8(&bytes).unwrap());
        }
    }
}
