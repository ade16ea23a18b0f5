//! Values of JSON, written in the order they are given.

use crate::constant::number;

/// A value of JSON.
#[derive(Debug, Clone, PartialEq)]
pub enum Json {
    /// A finite number, written so that it reads back as the same bits.
    Number(f64),
    /// A whole number.
    Count(usize),
    /// A text.
    Text(String),
    /// Values in their order.
    List(Vec<Json>),
    /// Fields in their order.
    Record(Vec<(&'static str, Json)>),
}

impl Json {
    /// A text.
    pub fn text(text: &str) -> Self {
        Self::Text(text.to_owned())
    }

    /// A list of numbers.
    pub fn numbers(values: &[f64]) -> Self {
        Self::List(values.iter().map(|value| Self::Number(*value)).collect())
    }

    /// The value as a document that ends in a line end.
    pub fn document(&self) -> String {
        let mut text = String::new();
        self.write(0, &mut text);
        text.push('\n');
        text
    }

    /// Written with an indent; lists of numbers stay on one line.
    fn write(&self, indent: usize, text: &mut String) {
        let inside = " ".repeat(indent + 2);
        match self {
            Self::Number(value) => text.push_str(&number(*value)),
            Self::Count(count) => text.push_str(&count.to_string()),
            Self::Text(content) => text.push_str(&quoted(content)),
            Self::List(items) => {
                let flat =
                    items.iter().all(|item| matches!(item, Self::Number(_) | Self::Count(_)));
                text.push('[');
                for (index, item) in items.iter().enumerate() {
                    text.push_str(if index > 0 { "," } else { "" });
                    if flat {
                        text.push_str(if index > 0 { " " } else { "" });
                    } else {
                        text.push('\n');
                        text.push_str(&inside);
                    }
                    item.write(indent + 2, text);
                }
                if !flat {
                    text.push('\n');
                    text.push_str(&inside[2..]);
                }
                text.push(']');
            }
            Self::Record(fields) => {
                text.push('{');
                for (index, (name, value)) in fields.iter().enumerate() {
                    text.push_str(if index > 0 { ",\n" } else { "\n" });
                    text.push_str(&inside);
                    text.push_str(&quoted(name));
                    text.push_str(": ");
                    value.write(indent + 2, text);
                }
                text.push('\n');
                text.push_str(&inside[2..]);
                text.push('}');
            }
        }
    }
}

fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted.push(' '),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}
