//! Stations along the span: Gauss points in segments, and integrals from the root and to the tip.

/// Stations of a blade with weights of integration.
#[derive(Debug, Clone)]
pub struct Span {
    /// Stations, R.
    pub x: Vec<f64>,
    /// Weights: `int_0^1 f dx = sum w f`.
    pub weight: Vec<f64>,
    /// Points of a segment.
    points: usize,
    /// Lengths of the segments.
    lengths: Vec<f64>,
    /// Integral of the polynomial through the points of `[0, 1]` from 0 to each of them, row by row.
    partial: Vec<f64>,
}

/// Gauss-Legendre nodes and weights on `[0, 1]`.
///
/// Newton's iteration on the Legendre polynomial, from the usual cosine guess.
pub fn gauss(points: usize) -> (Vec<f64>, Vec<f64>) {
    let n = points as f64;
    (0..points)
        .map(|k| {
            let mut t = -((k as f64 + 0.75) / (n + 0.5) * std::f64::consts::PI).cos();
            let mut slope = 1.0;
            for _ in 0..60 {
                let p = legendre(t, points + 1);
                slope = n * (t * p[points] - p[points - 1]) / (t * t - 1.0);
                let step = p[points] / slope;
                t -= step;
                if step.abs() < 1e-16 {
                    break;
                }
            }
            (0.5 * (1.0 + t), 1.0 / ((1.0 - t * t) * slope * slope))
        })
        .unzip()
}

/// The first Legendre polynomials at `t` in `[-1, 1]`.
pub fn legendre(t: f64, count: usize) -> Vec<f64> {
    let mut p = vec![1.0, t];
    for k in 2..count.max(2) {
        let n = k as f64;
        p.push(((2.0 * n - 1.0) * t * p[k - 1] - (n - 1.0) * p[k - 2]) / n);
    }
    p.truncate(count.max(1));
    p
}

impl Span {
    /// Gauss points in segments between `edges` inside (0, 1), none longer than `longest`.
    pub fn new(edges: &[f64], points: usize, longest: f64) -> Self {
        let mut ends: Vec<f64> =
            edges.iter().copied().filter(|own| *own > 1e-9 && *own < 1.0 - 1e-9).collect();
        ends.extend([0.0, 1.0]);
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        let mut cut = vec![0.0];
        for pair in ends.windows(2) {
            let length = pair[1] - pair[0];
            let pieces = (1..64_u32).find(|n| length / f64::from(*n) <= longest + 1e-12);
            let pieces = pieces.unwrap_or(64);
            cut.extend((1..=pieces).map(|n| pair[0] + length * f64::from(n) / f64::from(pieces)));
        }
        let (node, share) = gauss(points);
        let (mut x, mut weight, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
        for pair in cut.windows(2) {
            let length = pair[1] - pair[0];
            lengths.push(length);
            x.extend(node.iter().map(|own| pair[0] + length * own));
            weight.extend(share.iter().map(|own| length * own));
        }
        Self { x, weight, points, lengths, partial: partial_integrals(&node, &share) }
    }

    /// Number of stations.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there is no station.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// `int_0^x f` at every station, into `out`; returns `int_0^1 f`.
    pub fn from_root(&self, f: &[f64], out: &mut [f64]) -> f64 {
        let mut begun = 0.0;
        for (s, length) in self.lengths.iter().enumerate() {
            let at = s * self.points;
            let own = &f[at..at + self.points];
            for k in 0..self.points {
                let row = &self.partial[k * self.points..(k + 1) * self.points];
                let part: f64 = row.iter().zip(own).map(|(a, b)| a * b).sum();
                out[at + k] = begun + length * part;
            }
            let weights = &self.weight[at..at + self.points];
            begun += weights.iter().zip(own).map(|(a, b)| a * b).sum::<f64>();
        }
        begun
    }

    /// `int_x^1 f` at every station, into `out`.
    pub fn to_tip(&self, f: &[f64], out: &mut [f64]) {
        let whole = self.from_root(f, out);
        for own in out {
            *own = whole - *own;
        }
    }
}

/// `A[k][j] = int_0^(node k) l_j` of the Lagrange polynomials through the nodes, by their Legendre series.
fn partial_integrals(node: &[f64], share: &[f64]) -> Vec<f64> {
    let n = node.len();
    let series: Vec<Vec<f64>> = node.iter().map(|own| legendre(2.0 * own - 1.0, n + 1)).collect();
    let mut out = vec![0.0; n * n];
    for k in 0..n {
        for j in 0..n {
            let mut sum = node[k] * share[j];
            for m in 1..n {
                // int_-1^t P_m = (P_(m+1) - P_(m-1)) / (2m + 1); half of it on [0, 1]
                let whole = 0.5 * (series[k][m + 1] - series[k][m - 1]);
                sum += share[j] * series[j][m] * whole;
            }
            out[k * n + j] = sum;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_of_polynomials_are_exact() {
        let span = Span::new(&[0.35, 0.7, 0.75], 6, 0.2);
        let f: Vec<f64> = span.x.iter().map(|x| 6.0 * x.powi(5)).collect();
        let mut out = vec![0.0; span.len()];
        assert!((span.from_root(&f, &mut out) - 1.0).abs() < 1e-13);
        for (x, own) in span.x.iter().zip(&out) {
            assert!((own - x.powi(6)).abs() < 1e-13);
        }
        span.to_tip(&f, &mut out);
        for (x, own) in span.x.iter().zip(&out) {
            assert!((own - 1.0 + x.powi(6)).abs() < 1e-13);
        }
    }
}
