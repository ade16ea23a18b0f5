//! A linear map kept as the kernel fills it: blocks of rows whose values stand side by side.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]
#![expect(
    clippy::cast_possible_truncation,
    reason = "single precision is what is asked for a step"
)]

use crate::kernel::BLOCK;
use nalgebra::{DMatrix, RealField};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Blocks that one thread applies together.
const BLOCKS_TOGETHER: usize = 16;

/// Columns of a matrix that one thread fills together.
const COLUMNS_TOGETHER: usize = 64;

/// Sums that are carried side by side along a block.
const SUMS: usize = 4;

/// Some rows of a map: at most [`BLOCK`].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RowBlock {
    /// Where they stand in the map.
    pub(super) rows: Vec<usize>,
    /// Column by column.
    pub(super) columns: Vec<[f64; BLOCK]>,
}

/// A square map in blocks of rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RowBlocks(pub(super) Vec<RowBlock>);

impl RowBlocks {
    /// A map of an order by its entries at row and column.
    pub(super) fn from_fn(order: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let rows: Vec<usize> = (0..order).collect();
        let block = |rows: &[usize]| {
            let lane = |k: usize, column| rows.get(k).map_or(0.0, |row| entry(*row, column));
            let column = |column: usize| std::array::from_fn(|k| lane(k, column));
            RowBlock { rows: rows.to_vec(), columns: (0..order).map(column).collect() }
        };
        Self(rows.chunks(BLOCK).map(block).collect())
    }

    /// Rows, and columns.
    pub(super) fn order(&self) -> usize {
        self.0.first().map_or(0, |block| block.columns.len())
    }

    /// The product with a vector of that order.
    pub(super) fn times(&self, factors: &[f64]) -> Vec<f64> {
        let product =
            |block: &RowBlock| Arch::new().dispatch(Product { columns: &block.columns, factors });
        let blocks = self.0.par_iter().with_min_len(BLOCKS_TOGETHER);
        let products: Vec<[f64; BLOCK]> = blocks.map(product).collect();
        let mut out = vec![0.0; self.order()];
        for (block, product) in self.0.iter().zip(products) {
            for (&row, value) in block.rows.iter().zip(product) {
                out[row] = value;
            }
        }
        out
    }

    /// The same as a matrix.
    pub(super) fn matrix(&self) -> DMatrix<f64> {
        self.column_by_column(|block, column, _| self.0[block].columns[column])
    }

    /// The same less each row of another map in the same blocks times a factor of the row, in single precision.
    pub(super) fn less(&self, other: &Self, factors: &[f64]) -> DMatrix<f32> {
        self.column_by_column(|block, column, rows| {
            let mut values = self.0[block].columns[column];
            let less = other.0[block].columns[column].iter().zip(rows);
            for (value, (less, &row)) in values.iter_mut().zip(less) {
                *value -= less * factors[row];
            }
            values.map(|value| value as f32)
        })
    }

    /// A matrix whose values at the rows of a block and at a column are given.
    fn column_by_column<T: RealField>(
        &self,
        values: impl Fn(usize, usize, &[usize]) -> [T; BLOCK] + Sync,
    ) -> DMatrix<T> {
        let size = self.order();
        let mut matrix = DMatrix::zeros(size, size);
        let columns = matrix.as_mut_slice().par_chunks_mut(size.max(1)).enumerate();
        columns.with_min_len(COLUMNS_TOGETHER).for_each(|(column, out)| {
            for (block, RowBlock { rows, .. }) in self.0.iter().enumerate() {
                for (&row, value) in rows.iter().zip(values(block, column, rows)) {
                    out[row] = value;
                }
            }
        });
        matrix
    }

    /// The rows of the first azimuth given to every azimuth, with what is as far behind it.
    pub(super) fn turned(&self, panels: usize) -> Self {
        let size = self.order();
        let turned = |shift: usize| {
            self.0.iter().map(move |RowBlock { rows, columns }| {
                let mut columns = columns.clone();
                columns.rotate_right(shift);
                RowBlock { rows: rows.iter().map(|row| row + shift).collect(), columns }
            })
        };
        Self((0..size / panels).flat_map(|azimuth| turned(azimuth * panels)).collect())
    }
}

/// Rows times factors: a type of its own, for a closure would be called, not inlined, by the function that is compiled
/// for the vector unit.
struct Product<'a> {
    columns: &'a [[f64; BLOCK]],
    factors: &'a [f64],
}

impl WithSimd for Product<'_> {
    type Output = [f64; BLOCK];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [f64; BLOCK] {
        let mut sums = [[0.0; BLOCK]; SUMS];
        for (columns, factors) in self.columns.chunks(SUMS).zip(self.factors.chunks(SUMS)) {
            for ((sum, column), factor) in sums.iter_mut().zip(columns).zip(factors) {
                for (sum, value) in sum.iter_mut().zip(column) {
                    *sum += factor * value;
                }
            }
        }
        let [mut total, rest @ ..] = sums;
        for sum in rest {
            for (total, part) in total.iter_mut().zip(sum) {
                *total += part;
            }
        }
        total
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a map whose rows are out of order, and of one that turns with the azimuth.
    #[test]
    fn products_are_those_of_the_matrix() {
        let size = 22;
        let value = |row: usize, column: usize| ((row * size + column) as f64).sin();
        let block = |rows: Vec<usize>| {
            let lane = |row: Option<&usize>, column: usize| row.map_or(9.0, |r| value(*r, column));
            let column = |column: usize| std::array::from_fn(|k| lane(rows.get(k), column));
            RowBlock { columns: (0..size).map(column).collect(), rows }
        };
        let places: Vec<usize> = (0..size).map(|k| (5 * k + 3) % size).collect();
        let blocks = RowBlocks(places.chunks(BLOCK).map(|rows| block(rows.to_vec())).collect());
        let matrix = blocks.matrix();
        assert_eq!(matrix, DMatrix::from_fn(size, size, value));
        let other = RowBlocks::from_fn(size, value);
        assert_eq!(other.matrix(), matrix);
        let weights: Vec<f64> = (0..size).map(|k| (k as f64).cos()).collect();
        let less = |row: usize, column: usize| {
            (value(row, column) - value(row, column) * weights[row]) as f32
        };
        assert_eq!(other.less(&other, &weights), DMatrix::from_fn(size, size, less));
        let factors: Vec<f64> = (0..size).map(|k| 0.3 - 0.02 * k as f64).collect();
        let expected = &matrix * nalgebra::DVector::from_column_slice(&factors);
        for (found, expected) in blocks.times(&factors).iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
        let turned = RowBlocks(vec![block(vec![0, 1])]).turned(2).matrix();
        let expected =
            |row: usize, column: usize| value(row % 2, (column + size - (row - row % 2)) % size);
        assert_eq!(turned, DMatrix::from_fn(size, size, expected));
    }
}
