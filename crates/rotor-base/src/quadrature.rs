//! Gauss quadrature and Lagrange interpolation on [-1, 1].

/// Nodes and weights of a quadrature rule on [-1, 1].
#[derive(Debug, Clone, PartialEq)]
pub struct QuadratureRule {
    /// Nodes, ascending.
    pub nodes: Vec<f64>,
    /// Weights, summing to 2.
    pub weights: Vec<f64>,
}

/// Value and derivative of the Legendre polynomial of degree `n`.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (1.0, x);
    if n == 0 {
        return (1.0, 0.0);
    }
    for k in 2..=n {
        let k = k as f64;
        (previous, current) = (current, ((2.0 * k - 1.0) * x * current - (k - 1.0) * previous) / k);
    }
    let nf = n as f64;
    (current, nf * (previous - x * current) / (1.0 - x * x))
}

/// Newton's method from a good start; the iterations it takes are bounded and few.
fn polish(mut x: f64, step: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..50 {
        let dx = step(x);
        x -= dx;
        if dx.abs() < 1e-16 {
            break;
        }
    }
    x
}

/// Gauss-Legendre rule with `count >= 1` nodes: exact for polynomials of degree `2 count - 1`.
///
/// Source: Abramowitz and Stegun, 25.4.29 and 25.4.30.
pub fn gauss_legendre(count: usize) -> QuadratureRule {
    let n = count.max(1);
    let nodes: Vec<f64> = (0..n)
        .map(|i| {
            let start = -(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            polish(start, |x| {
                let (p, dp) = legendre(n, x);
                p / dp
            })
        })
        .collect();
    let weights = nodes
        .iter()
        .map(|&x| {
            let dp = legendre(n, x).1;
            2.0 / ((1.0 - x * x) * dp * dp)
        })
        .collect();
    QuadratureRule { nodes, weights }
}

/// The `count >= 2` Gauss-Lobatto nodes on [-1, 1], ascending, both ends included.
///
/// Inner nodes are the zeros of `P'_{count-1}`. Source: Abramowitz and Stegun, 25.4.32.
pub fn gauss_lobatto_nodes(count: usize) -> Vec<f64> {
    let degree = count.max(2) - 1;
    let nf = degree as f64;
    let mut nodes = vec![-1.0];
    nodes.extend((1..degree).map(|i| {
        let start = -(std::f64::consts::PI * i as f64 / nf).cos();
        polish(start, |x| {
            let (p, dp) = legendre(degree, x);
            let ddp = (2.0 * x * dp - nf * (nf + 1.0) * p) / (1.0 - x * x);
            dp / ddp
        })
    }));
    nodes.push(1.0);
    nodes
}

/// Lagrange polynomials through given distinct nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct LagrangeBasis {
    nodes: Vec<f64>,
}

impl LagrangeBasis {
    /// The basis through `nodes`, which must be distinct.
    pub fn new(nodes: Vec<f64>) -> Self {
        Self { nodes }
    }

    /// The nodes.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Value, first and second derivative of every basis polynomial at `x`.
    pub fn evaluate(&self, x: f64) -> Vec<[f64; 3]> {
        let n = self.nodes.len();
        (0..n)
            .map(|i| {
                // product rule carried along: (f, f', f'') of prod_j (x - x_j)/(x_i - x_j)
                let mut f = [1.0, 0.0, 0.0];
                for j in (0..n).filter(|&j| j != i) {
                    let scale = 1.0 / (self.nodes[i] - self.nodes[j]);
                    let factor = (x - self.nodes[j]) * scale;
                    f = [
                        f[0] * factor,
                        f[1] * factor + f[0] * scale,
                        f[2] * factor + 2.0 * f[1] * scale,
                    ];
                }
                f
            })
            .collect()
    }

    /// Matrix of integrals, row `k`, column `i`: integral of basis polynomial `i` from -1 to node
    /// `k`; a last row holds the integrals over the whole of [-1, 1].
    pub fn integration_matrix(&self) -> Vec<Vec<f64>> {
        self.nodes.iter().copied().chain([1.0]).map(|upper| self.integrals_to(upper)).collect()
    }

    /// Integral of every basis polynomial from -1 to `upper`.
    pub fn integrals_to(&self, upper: f64) -> Vec<f64> {
        let n = self.nodes.len();
        let rule = gauss_legendre(n.div_ceil(2) + 1);
        let half = 0.5 * (upper + 1.0);
        let mut row = vec![0.0; n];
        for (&node, &weight) in rule.nodes.iter().zip(&rule.weights) {
            let x = -1.0 + half * (node + 1.0);
            for (r, [value, ..]) in row.iter_mut().zip(self.evaluate(x)) {
                *r += half * weight * value;
            }
        }
        row
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn gauss_is_exact_to_its_degree_and_not_beyond() {
        for n in 1..=12 {
            let rule = gauss_legendre(n);
            let integral = |power: i32| -> f64 {
                rule.nodes.iter().zip(&rule.weights).map(|(x, w)| w * x.powi(power)).sum()
            };
            for power in 0..2 * n {
                let exact = if power % 2 == 0 { 2.0 / (power as f64 + 1.0) } else { 0.0 };
                assert_abs_diff_eq!(
                    integral(i32::try_from(power).unwrap()),
                    exact,
                    epsilon = 1e-14
                );
            }
            let beyond = 2 * n;
            let exact = 2.0 / (beyond as f64 + 1.0);
            assert!((integral(i32::try_from(beyond).unwrap()) - exact).abs() > 1e-8);
        }
    }

    #[test]
    fn lobatto_nodes_of_order_5() {
        // closed form: +-1, +-sqrt((7 +- 2 sqrt 7)/21)
        let nodes = gauss_lobatto_nodes(6);
        let r = |sign: f64| ((7.0 + sign * 2.0 * 7.0_f64.sqrt()) / 21.0).sqrt();
        let expected = [-1.0, -r(1.0), -r(-1.0), r(-1.0), r(1.0), 1.0];
        for (got, want) in nodes.iter().zip(expected) {
            assert_abs_diff_eq!(*got, want, epsilon = 1e-15);
        }
    }

    #[test]
    fn lagrange_reproduces_polynomials_and_their_derivatives() {
        let basis = LagrangeBasis::new(gauss_lobatto_nodes(6));
        let f = |x: f64| 1.0 + x - 3.0 * x.powi(3) + 2.0 * x.powi(5);
        let values: Vec<f64> = basis.nodes().iter().map(|&x| f(x)).collect();
        for x in [-0.9, -0.2, 0.0, 0.55, 1.0] {
            let sum = |k: usize| -> f64 {
                basis.evaluate(x).iter().zip(&values).map(|(b, v)| b[k] * v).sum()
            };
            assert_abs_diff_eq!(sum(0), f(x), epsilon = 1e-13);
            assert_abs_diff_eq!(sum(1), 1.0 - 9.0 * x * x + 10.0 * x.powi(4), epsilon = 1e-12);
            assert_abs_diff_eq!(sum(2), -18.0 * x + 40.0 * x.powi(3), epsilon = 1e-11);
        }
    }

    #[test]
    fn integration_matrix_integrates() {
        let basis = LagrangeBasis::new(gauss_legendre(4).nodes);
        let rows = basis.integration_matrix();
        let values: Vec<f64> = basis.nodes().iter().map(|x| x.powi(3) + 1.0).collect();
        let uppers: Vec<f64> = basis.nodes().iter().copied().chain([1.0]).collect();
        for (row, x) in rows.iter().zip(uppers) {
            let got: f64 = row.iter().zip(&values).map(|(a, b)| a * b).sum();
            assert_abs_diff_eq!(got, (x.powi(4) - 1.0) / 4.0 + x + 1.0, epsilon = 1e-14);
        }
    }
}
