//! The number of a cell: decimal points or commas, thousands separators, missing values, times of day.

/// Words that instruments and spreadsheets write where there is no number, in lower case.
const MISSING: [&str; 40] = [
    "nan",
    "-nan",
    "nan(ind)",
    "-nan(ind)",
    "nan(snan)",
    "-nan(snan)",
    "na",
    "n/a",
    "#n/a",
    "#nv",
    "null",
    "none",
    "-",
    "--",
    "---",
    "inf",
    "-inf",
    "+inf",
    "infinity",
    "-infinity",
    "∞",
    "-∞",
    "over",
    "overload",
    "overflow",
    "ovld",
    "ol",
    "1.#qnan",
    "1.#inf",
    "-1.#inf",
    "-1.#ind",
    "#num!",
    "#value!",
    "#wert!",
    "#div/0!",
    "#ref!",
    "#bezug!",
    "#name?",
    "#null!",
    "#zahl!",
];
/// A number beyond this is an instrument's word for overflow, such as the 9.9e37 of SCPI.
const LARGEST: f64 = 1e20;

/// The number of a cell; `NaN` where it says that there is none, none where it is another text.
pub(super) fn number(text: &str, decimal: char) -> Option<f64> {
    if text.is_empty() {
        return Some(f64::NAN);
    }
    let plain = if decimal == ',' && text.contains(',') { None } else { text.parse::<f64>().ok() };
    // a point in a table of decimal commas is no decimal point
    let plain = plain.filter(|_| decimal != ',' || !text.contains('.'));
    let value = plain
        .or_else(|| written(text, decimal))
        .or_else(|| MISSING.contains(&text.to_lowercase().as_str()).then_some(f64::NAN))?;
    Some(if value.abs() <= LARGEST { value } else { f64::NAN })
}

/// A number with a decimal comma, with thousands separators or with Fortran's exponent.
fn written(text: &str, decimal: char) -> Option<f64> {
    let first = text.chars().next()?;
    if !(first.is_ascii_digit() || matches!(first, '+' | '-' | '−' | '.' | ',')) {
        return None;
    }
    let other = if decimal == ',' { '.' } else { ',' };
    let thousands = ['\u{a0}', '\u{202f}', '\'', '’', ' ', other];
    let (whole, rest) = match text.find([decimal, 'e', 'E', 'd', 'D']) {
        Some(at) => text.split_at(at),
        None => (text, ""),
    };
    let digits = whole.trim_start_matches(['+', '-', '−']);
    let groups: Vec<&str> = digits.split(thousands).collect();
    let is_group = |group: &&str| group.len() == 3 && group.bytes().all(|b| b.is_ascii_digit());
    let grouped = groups.len() > 1;
    if grouped {
        let leads = (1..=3).contains(&groups[0].len()) && !groups[0].starts_with('0');
        // one group of three alone could be decimals
        let is_clear = groups.len() > 2 || rest.starts_with(decimal) || !digits.contains(other);
        if !leads || !is_clear || !groups[1..].iter().all(is_group) {
            return None;
        }
    }
    let sign = if whole.starts_with(['-', '−']) { "-" } else { "" };
    let rest: String = rest
        .chars()
        .map(|c| match c {
            'd' | 'D' => 'e',
            c if c == decimal => '.',
            c => c,
        })
        .collect();
    format!("{sign}{}{rest}", groups.concat()).parse().ok().filter(|v: &f64| v.is_finite())
}

/// Seconds of a time of day, with a date since 1970: `2026-01-05T10:00:00.005+01:00`, `05.01.2026 10:00:00,005`,
/// `1/5/2026 10:00:00.005 AM`, `10:00:00:005`, `59:31.5`. The zone is left out: it is the same for all.
///
/// Differs between countries: of `1/5/2026` the first number is the month where it can be one.
pub(super) fn stamp(text: &str) -> Option<f64> {
    let (date, time) = match text.split_once([' ', 'T']) {
        Some((date, time)) if date.contains(['-', '/', '.']) && !date.contains(':') => {
            (Some(date), time.trim())
        }
        _ => (None, text),
    };
    let (time, half) = match time.rsplit_once(' ') {
        Some((time, "AM" | "am")) => (time, Some(0.0)),
        Some((time, "PM" | "pm")) => (time, Some(12.0)),
        _ => (time, None),
    };
    let time = time.trim_end_matches('Z');
    let time = time.split_once('+').map_or(time, |(time, _)| time);
    let time = time.rsplit_once('-').map_or(time, |(time, _)| time);
    let parts: Vec<&str> = time.split(':').collect();
    let seconds = |text: &str| {
        let is_plain = text.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'.' | b','));
        text.replace(',', ".").parse::<f64>().ok().filter(|_| is_plain)
    };
    let clock = match parts[..] {
        // only with decimals is it told from hours and minutes
        [m, s] if s.contains(['.', ',']) => 60.0 * seconds(m)? + seconds(s)?,
        [h, m, s] => 3600.0 * hours(seconds(h)?, half) + 60.0 * seconds(m)? + seconds(s)?,
        [h, m, s, thousandths] => {
            let part = format!("{s}.{thousandths}");
            3600.0 * hours(seconds(h)?, half) + 60.0 * seconds(m)? + seconds(&part)?
        }
        _ => return None,
    };
    Some(date.map_or(Some(0.0), days)? * 86_400.0 + clock)
}

/// Hours of a day of twice twelve.
fn hours(hours: f64, half: Option<f64>) -> f64 {
    half.map_or(hours, |half| hours % 12.0 + half)
}

/// Days from 1970-01-01 to a date of the Gregorian calendar.
///
/// Source: Howard Hinnant, "chrono-Compatible Low-Level Date Algorithms", `days_from_civil`.
fn days(date: &str) -> Option<f64> {
    let parts: Vec<i64> =
        date.split(['-', '/', '.']).map(|part| part.parse().ok()).collect::<Option<_>>()?;
    let &[a, b, c] = &parts[..] else { return None };
    let (year, month, day) = match () {
        () if a > 31 => (a, b, c),
        () if date.contains('/') && a <= 12 => (c, a, b),
        () => (c, b, a),
    };
    if !(1..=12).contains(&month) || !(1..=31).contains(&day) || !(0..=9999).contains(&year) {
        return None;
    }
    let year = if month <= 2 { year - 1 } else { year };
    let of_era = year.rem_euclid(400);
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    let of_era = of_era * 365 + of_era / 4 - of_era / 100 + of_year;
    Some((year.div_euclid(400) * 146_097 + of_era - 719_468) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_as_they_are_written() {
        for (text, decimal, expected) in [
            ("-1.5e-3", '.', Some(-1.5e-3)),
            ("0,005", ',', Some(0.005)),
            ("279\u{a0}123,4", ',', Some(279_123.4)),
            ("1.234,5", ',', Some(1234.5)),
            ("1,234.5", '.', Some(1234.5)),
            ("1,234,567", '.', Some(1_234_567.0)),
            ("1'234.5", '.', Some(1234.5)),
            ("0.5000D-02", '.', Some(0.005)),
            ("-2,5E+01", ',', Some(-25.0)),
            // one group of three may be decimals
            ("1,234", '.', None),
            ("1.234", ',', None),
            ("1,234E-03", '.', None),
            ("1.234E-3", ',', None),
            ("0,005", '.', None),
            ("12,34.5", '.', None),
            ("abc", '.', None),
            ("e5", '.', None),
            ("1.5 V", '.', None),
        ] {
            assert_eq!(number(text, decimal), expected, "{text}");
        }
        for missing in ["", "NaN", "#N/A", "9.91E+37", "Infinity", "--"] {
            assert!(number(missing, '.').unwrap().is_nan(), "{missing}");
        }
    }

    #[test]
    fn times_of_day() {
        let day = 20_458.0 * 86_400.0 + 36_000.0;
        for (text, expected) in [
            ("2026-01-05T10:00:00.5+01:00", Some(day + 0.5)),
            ("2026-01-05 10:00:00.5", Some(day + 0.5)),
            ("05.01.2026 10:00:00,5", Some(day + 0.5)),
            ("1/5/2026 10:00:00.5 AM", Some(day + 0.5)),
            ("1/5/2026 10:00:00:500", Some(day + 0.5)),
            ("2026/01/05 12:00:00 AM", Some(day - 36_000.0)),
            ("10:00:01", Some(36_001.0)),
            ("59:31.5", Some(3571.5)),
            ("10:00", None),
            ("0.5", None),
            ("2026-13-05 10:00:00", None),
            ("a:b:c", None),
        ] {
            assert_eq!(stamp(text), expected, "{text}");
        }
    }
}
