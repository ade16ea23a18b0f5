//! C81 files: read by column and by count, written and read back exactly, never a panic.
#![expect(clippy::float_cmp, reason = "a file gives the number it spells, to the last bit")]
#![expect(clippy::disallowed_methods, reason = "tests read the shipped table")]

use approx::{assert_abs_diff_eq, assert_relative_eq};
use flap_aero::{AeroError, AirfoilSpan, C81Airfoil, C81Table};
use proptest::prelude::*;

/// Synthetic: a lift table of eleven Mach numbers whose fields touch, a drag table of nine, a moment
/// table of one.
const TOUCHING: &str = "\
SYNTHETIC, FIELDS TOUCH       11 3 9 2 1 2
          0.10   0.20   0.30   0.40   0.50   0.55   0.60   0.65   0.70
          0.75   0.80
-180.00-0.1234-0.2234-0.3234-0.4234-0.5234-0.6234-0.7234-0.8234-0.9234
       -1.0234-1.1234
   0.00.001234  0.200  0.300  0.400  0.500  0.600  0.700  0.800-.90001
         1.0E0  1.1D0
 180.00 0.1234 0.2234 0.3234 0.4234 0.5234 0.6234 0.7234 0.8234 0.9234
        1.0234 1.1234
          0.10   0.20   0.30   0.40   0.50   0.55   0.60   0.65   0.70
-180.     0.01   0.01   0.01   0.01   0.01   0.01   0.01   0.01   0.01
 180.     0.02   0.02   0.02   0.02   0.02   0.02   0.02   0.02   0.02
          0.30
-180.   -0.100
 180.    0.100
";

/// The same kind of table with its numbers apart by blanks, as other programs write it.
const APART: &str = "\
SYNTHETIC BLANKS 2 2 2 2 2 2
0.25 0.75
-10 -1.23456789 -1.4
10 1.23456789 1.4

0.25 0.75
-10 0.01 0.02
10 0.01 0.02
0.25 0.75
-10 -0.001 -0.002
10 -0.001 -0.002
";

#[test]
fn touching_fields_are_cut_by_column() {
    let airfoil = C81Airfoil::read(TOUCHING).unwrap();
    assert_eq!(airfoil.name, "SYNTHETIC, FIELDS TOUCH");
    assert_eq!(airfoil.lift.machs().len(), 11);
    let row = airfoil.lift.row(0);
    for (i, value) in row.iter().enumerate() {
        let expected = -0.1234 - 0.1 * f64::from(u32::try_from(i).unwrap());
        assert_abs_diff_eq!(*value, expected, epsilon = 1e-12);
    }
    let middle = airfoil.lift.row(1);
    assert_eq!([middle[0], middle[8], middle[9], middle[10]], [0.001_234, -0.900_01, 1.0, 1.1]);
    assert_eq!(airfoil.drag.row(1), [0.02; 9]);
    assert_eq!(airfoil.moment.row(1), [0.1]);
}

#[test]
fn numbers_apart_by_blanks_are_counted() {
    let airfoil = C81Airfoil::read(APART).unwrap();
    assert_eq!(airfoil.name, "SYNTHETIC BLANKS");
    assert_eq!(airfoil.lift.row(1), [1.234_567_89, 1.4]);
    assert_eq!(airfoil.lift.incidences_deg(), [-10.0, 10.0]);
}

/// Programs break rows of nine Mach numbers or more at different places: the count decides.
#[test]
fn rows_may_be_broken_anywhere_between_blanks() {
    let machs: Vec<String> = (0..10).map(|i| format!("0.{i}5")).collect();
    let row = |alpha: i32| -> Vec<String> {
        let values = (0..10).map(|i| format!("{:.3}", 0.1 * f64::from(alpha + i)));
        std::iter::once(alpha.to_string()).chain(values).collect()
    };
    let text = |at: usize| {
        let broken = |words: &[String]| -> String {
            words.chunks(at).map(|line| line.join(" ") + "\n").collect()
        };
        let table = [broken(&machs), broken(&row(-2)), broken(&row(3))].concat();
        format!("ANYWHERE 10 2 10 2 10 2\n{table}{table}{table}")
    };
    let whole = C81Airfoil::read(&text(20)).unwrap();
    assert_eq!(whole.lift.row(1)[9], 1.2);
    for at in [2, 4, 8, 9, 10] {
        assert_eq!(C81Airfoil::read(&text(at)).unwrap(), whole, "lines of {at}");
    }
}

#[test]
fn written_and_read_back_exactly() {
    let airfoil = C81Airfoil::read(TOUCHING).unwrap();
    let text = airfoil.write().unwrap();
    let again = C81Airfoil::read(&text).unwrap();
    assert_eq!(again, airfoil);
    assert_eq!(again.write().unwrap(), text);
    // too many digits: refused, and written once rounded
    let long = C81Airfoil::read(APART).unwrap();
    assert!(matches!(long.write(), Err(AeroError::C81NotWritable { .. })));
    let rounded = long.rounded();
    assert_abs_diff_eq!(rounded.lift.row(1)[0], 1.234_567_89, epsilon = 5e-6);
    assert_eq!(C81Airfoil::read(&rounded.write().unwrap()).unwrap(), rounded);
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let broken = TOUCHING.replace("-0.6234", "-0.6x34");
    assert!(
        matches!(C81Airfoil::read(&broken), Err(AeroError::C81Text { line: 4, column: 43, .. })),
        "{:?}",
        C81Airfoil::read(&broken)
    );
    let short = TOUCHING.lines().take(9).collect::<Vec<_>>().join("\n");
    assert!(matches!(C81Airfoil::read(&short), Err(AeroError::C81Text { line: 9, .. })));
    let backward = TOUCHING.replace(" 180.00 0.1234", "-190.00 0.1234");
    let error = C81Airfoil::read(&backward).unwrap_err();
    let AeroError::C81Text { line, expected, .. } = error else { panic!("{error}") };
    assert!(expected.contains("above the one before it in the lift table"), "{expected}");
    assert!(TOUCHING.lines().nth(line - 1).unwrap().starts_with(" 180.00"), "{line}");
    // cut off inside a row of the last table
    let whole = TOUCHING.trim_end();
    let inside = &whole[..whole.rfind('\n').unwrap()];
    let error = C81Airfoil::read(inside).unwrap_err().to_string();
    assert!(error.contains("the moment table") && error.contains("the counts"), "{error}");
    // a count too small cuts a table off; a remark after the tables does no harm
    let cut = TOUCHING.replace(" 1 2\n", " 1 1\n");
    assert_ne!(cut, TOUCHING);
    assert!(matches!(C81Airfoil::read(&cut), Err(AeroError::C81Text { line: 15, .. })));
    let remark = format!("{TOUCHING}measured by nobody, 3 times\n");
    assert_eq!(C81Airfoil::read(&remark), C81Airfoil::read(TOUCHING));
    for text in ["", "\n\n", "no counts", "NAME                           0 0 0 0 0 0"] {
        assert!(C81Airfoil::read(text).is_err(), "{text:?}");
    }
}

#[test]
fn interpolation_is_exact_where_the_table_is_linear() {
    // cl = 0.1 + 0.02 alpha + 0.3 M + 0.004 alpha M: bilinear, so exact everywhere inside
    let value = |a: f64, m: f64| 0.1 + 0.02 * a + 0.3 * m + 0.004 * a * m;
    let machs = vec![0.2, 0.35, 0.8];
    let angles = vec![-20.0, -3.0, 0.0, 7.0, 25.0];
    let values = angles.iter().flat_map(|a| machs.iter().map(move |m| value(*a, *m))).collect();
    let lift = C81Table::new(machs, angles, values).unwrap();
    let flat = C81Table::new(vec![0.0], vec![0.0], vec![0.01]).unwrap();
    let airfoil =
        C81Airfoil { name: "LINEAR".into(), lift, drag: flat.clone(), moment: flat.clone() };
    for (a, m) in [(-11.3_f64, 0.21), (1.0, 0.5), (24.9, 0.79), (0.0, 0.35)] {
        let point = airfoil.at(a.to_radians(), m);
        assert_relative_eq!(point.value.lift, value(a, m), max_relative = 1e-13);
        let slope = (0.02 + 0.004 * m).to_degrees();
        assert_relative_eq!(point.per_incidence.lift, slope, max_relative = 1e-12);
        assert_relative_eq!(point.per_mach.lift, 0.3 + 0.004 * a, max_relative = 1e-12);
        assert_abs_diff_eq!(point.value.drag, 0.01);
        assert_abs_diff_eq!(point.per_mach.drag, 0.0);
    }
    // beyond the ends the end values, without slope; whole turns change nothing
    let beyond = airfoil.at(40.0_f64.to_radians(), 0.95);
    assert_relative_eq!(beyond.value.lift, value(25.0, 0.8), max_relative = 1e-13);
    assert_abs_diff_eq!(beyond.per_incidence.lift, 0.0);
    let turned = airfoil.at((1.0_f64 - 720.0).to_radians(), 0.5);
    assert_relative_eq!(turned.value.lift, value(1.0, 0.5), max_relative = 1e-12);
}

/// A table of `sin(2 alpha)` halves its spacing, the error quarters.
#[test]
fn interpolation_is_second_order() {
    let error = |count: usize| {
        let angles: Vec<f64> =
            (0..=count).map(|i| -180.0 + 360.0 * i as f64 / count as f64).collect();
        let values = angles.iter().map(|a| (2.0 * a.to_radians()).sin()).collect();
        let table = C81Table::new(vec![0.3], angles, values).unwrap();
        (0..997)
            .map(|i| {
                let a = -180.0 + 360.0 * f64::from(i) / 997.0;
                (table.at(a, 0.3)[0] - (2.0 * a.to_radians()).sin()).abs()
            })
            .fold(0.0, f64::max)
    };
    let errors = [90, 180, 360].map(error);
    for pair in errors.windows(2) {
        assert!(((pair[0] / pair[1]).log2() - 2.0).abs() < 0.05, "{errors:?}");
    }
}

#[test]
fn aerofoils_are_blended_along_the_span() {
    let constant = |value: f64| {
        let table = C81Table::new(vec![0.0], vec![0.0], vec![value]).unwrap();
        C81Airfoil { name: String::new(), lift: table.clone(), drag: table.clone(), moment: table }
    };
    let span = AirfoilSpan::new(vec![(0.2, constant(1.0)), (0.8, constant(4.0))]).unwrap();
    for (station, expected) in [(0.0, 1.0), (0.2, 1.0), (0.4, 2.0), (0.8, 4.0), (1.0, 4.0)] {
        assert_relative_eq!(span.at(station, 0.1, 0.3).value.lift, expected, max_relative = 1e-14);
    }
    let unsorted = AirfoilSpan::new(vec![(0.8, constant(1.0)), (0.2, constant(4.0))]);
    assert!(matches!(unsorted, Err(AeroError::C81Order { .. })));
    assert!(AirfoilSpan::new(Vec::new()).is_err());
}

#[test]
fn negative_mach_numbers_are_refused_and_negative_drag_is_found() {
    let plate = |mach: &str, drag: &str| {
        let table = |value: &str| format!("       {mach:>7}   0.60\n   0.  {value:>7}    0.1\n");
        let tables = [table("0.1"), table(drag), table("0.0")].concat();
        C81Airfoil::read(&format!("PLATE                          2 1 2 1 2 1\n{tables}"))
    };
    assert_eq!(plate("0.20", "0.01").unwrap().negative_drag(), None);
    assert_eq!(plate("0.20", "-0.01").unwrap().negative_drag(), Some([0.0, 0.2, -0.01]));
    let error = plate("-0.20", "0.01").unwrap_err().to_string();
    assert!(
        error.contains("line 2") && error.contains("of the lift table of 0 or more"),
        "{error}"
    );
    assert!(C81Table::new(vec![-0.1], vec![0.0], vec![0.0]).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Any text at all: an aerofoil or an error, never a panic.
    #[test]
    fn any_text_is_read_without_panic(text in "\\PC{0,400}") {
        let _ = C81Airfoil::read(&text);
    }

    /// A file with damage: characters changed, taken out, put in, lines cut.
    #[test]
    fn a_damaged_file_is_read_without_panic(
        damage in prop::collection::vec((0..1200_usize, any::<char>(), 0..3_u8), 1..12),
        end in 0..1300_usize,
    ) {
        let mut characters: Vec<char> = TOUCHING.chars().collect();
        for (place, character, kind) in damage {
            let place = place % characters.len();
            match kind {
                0 => characters[place] = character,
                1 => characters.insert(place, character),
                _ => { characters.remove(place); }
            }
        }
        let text: String = characters.into_iter().take(end).collect();
        if let Ok(airfoil) = C81Airfoil::read(&text) {
            let _ = airfoil.at(0.1, 0.4);
        }
    }

    /// Any numbers: rounded to seven columns, written, read back to the last bit.
    #[test]
    fn rounded_aerofoils_survive_the_file(
        values in prop::collection::vec(-2000.0..2000.0_f64, 33),
        small in prop::collection::vec(-1e-3..1e-3_f64, 3),
    ) {
        let machs: Vec<f64> = (0..11).map(|i| 0.08 * f64::from(i)).collect();
        let lift = C81Table::new(machs, vec![-180.0, 0.5, 180.0], values).unwrap();
        let other = C81Table::new(vec![0.0], vec![-1.0, 0.0, 1.0], small).unwrap();
        let airfoil = C81Airfoil {
            name: "ANY".into(), lift, drag: other.clone(), moment: other,
        }.rounded();
        let text = airfoil.write().unwrap();
        prop_assert!(text.lines().all(|line| line.chars().count() <= 70));
        prop_assert_eq!(C81Airfoil::read(&text).unwrap(), airfoil);
    }
}

/// The shipped synthetic table: symmetric, attached and stalled as its formula says, and written as the
/// writer writes.
#[test]
fn the_shipped_synthetic_table_is_its_formula() {
    let path =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/airfoils/naca0012_synthetic.c81");
    let text = std::fs::read_to_string(path).unwrap();
    let airfoil = C81Airfoil::read(&text).unwrap();
    assert_eq!(airfoil.write().unwrap(), text);
    for degrees in [0.0_f64, 4.0, 12.0, 26.0, 60.0, 90.0, 135.0, 171.0] {
        for mach in [0.0, 0.33, 0.8] {
            let [up, down] = [1.0, -1.0].map(|s| airfoil.at(s * degrees.to_radians(), mach).value);
            assert!((up.lift + down.lift).abs() < 1e-12, "{degrees} {mach}");
            assert!((up.drag - down.drag).abs() < 1e-12 && up.drag > 0.0, "{degrees} {mach}");
            assert!((up.moment + down.moment).abs() < 1e-12, "{degrees} {mach}");
        }
    }
    // Mach 0.3, 10 and 18 deg: f by the two branches of the separation law, alpha1 15.25, S 3 and 2.3 deg
    for (degrees, f) in [
        (10.0_f64, 1.0 - 0.3 * ((10.0_f64 - 15.25) / 3.0).exp()),
        (18.0, 0.04 + 0.66 * ((15.25_f64 - 18.0) / 2.3).exp()),
    ] {
        let a = degrees.to_radians();
        let slope = std::f64::consts::TAU / (1.0_f64 - 0.09).sqrt();
        let normal = slope * a * (0.5 * (1.0 + f.sqrt())).powi(2);
        let chord = 0.965 * slope * a * a * f.sqrt();
        let got = airfoil.at(a, 0.3).value;
        assert!((got.lift - (normal * a.cos() + chord * a.sin())).abs() < 1e-4, "{degrees}");
        assert!((got.drag - (0.008 + normal * a.sin() - chord * a.cos())).abs() < 1e-4);
    }
    // behind, lift follows the normal velocity too
    assert!(airfoil.at(175.0_f64.to_radians(), 0.3).value.lift < -0.3);
}
