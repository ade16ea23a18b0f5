//! Arrays of numbers whose indices have names and units.

/// What one index of an array runs over.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Axis {
    /// What it is, one word such as `load`.
    pub name: String,
    /// Name of every place.
    pub labels: Vec<String>,
    /// Unit of every place; empty for a pure number.
    pub units: Vec<String>,
}

impl Axis {
    /// An axis whose places have one unit in common.
    pub fn of_unit(name: &str, labels: Vec<String>, unit: &str) -> Self {
        let units = vec![unit.to_owned(); labels.len()];
        Self { name: name.to_owned(), labels, units }
    }
}

/// Numbers over one, two or three axes: element, row and column, or row, column and page.
#[derive(Debug, Clone, PartialEq)]
pub struct LabelledArray {
    /// An identifier of MATLAB, at most 31 characters.
    pub name: String,
    /// What it is, with the rule for the unit of an element, in one sentence.
    pub meaning: String,
    /// One to three.
    pub axes: Vec<Axis>,
    /// Finite, the first index running fastest, as many as the labels of all axes multiply to.
    pub values: Vec<f64>,
}

impl LabelledArray {
    /// From a function of the places.
    pub fn from_fn(
        name: &str,
        meaning: &str,
        axes: Vec<Axis>,
        of: impl Fn(usize, usize, usize) -> f64,
    ) -> Self {
        let [rows, columns, pages] = sizes(&axes);
        let mut values = Vec::with_capacity(rows * columns * pages);
        for page in 0..pages {
            for column in 0..columns {
                values.extend((0..rows).map(|row| of(row, column, page)));
            }
        }
        Self { name: name.to_owned(), meaning: meaning.to_owned(), axes, values }
    }

    /// Rows, columns and pages; 1 where there is no such axis.
    pub fn sizes(&self) -> [usize; 3] {
        sizes(&self.axes)
    }

    /// The element of a row, a column and a page; none outside.
    pub fn at(&self, row: usize, column: usize, page: usize) -> Option<f64> {
        let [rows, columns, pages] = self.sizes();
        let is_inside = row < rows && column < columns && page < pages;
        self.values.get((page * columns + column) * rows + row).copied().filter(|_| is_inside)
    }
}

fn sizes(axes: &[Axis]) -> [usize; 3] {
    std::array::from_fn(|k| axes.get(k).map_or(1, |axis| axis.labels.len()))
}

/// Arrays that belong together, with what a reader must know.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Document {
    /// What the arrays are of.
    pub title: String,
    /// How they were found and what they hold for, in sentences.
    pub notes: Vec<String>,
    /// The arrays, each of another name.
    pub arrays: Vec<LabelledArray>,
}
