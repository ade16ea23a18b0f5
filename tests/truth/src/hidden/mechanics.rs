//! Hidden effects between the ceramic and the sensor.

/// A lever that is not ideal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mechanics {
    /// Two modes side by side, the first with 95 % of the static motion, the second at 2.7 times its
    /// frequency with 5 % and the same damping ratio.
    Resonance {
        /// Frequency of the first mode, Hz.
        frequency_hz: f64,
        /// Damping ratio.
        damping_ratio: f64,
    },
    /// Three plays side by side, of 0.8, 1 and 1.2 times the width.
    Backlash {
        /// Mean total width, um.
        width_um: f64,
    },
    /// Bristles on the driven part that bend before they slip (Dahl) and slip more easily in motion
    /// (Stribeck), behind the spring of the linkage.
    ///
    /// ```text
    /// y = x - z,   dz/dy = 8 (1 - sgn(dy) z/g),   g = w/2 (1 + 0.15 exp(-(x'/2000 um/s)^2))
    /// ```
    /// `z` is the stretch of the spring; the bristles are 8 times as stiff. The target never moves
    /// against the ceramic.
    Friction {
        /// Total width in fast motion, `w = 2 F_c/k`, um.
        width_um: f64,
    },
    /// A spring load that stiffens: `y (1 + ratio (1 + 0.1 (y/250 um)^2)) = x`.
    Load {
        /// Stiffness of the load over that of the actuator, at small motion.
        ratio: f64,
    },
    /// A force with the square of the speed: `y + c |y'| y' = x`.
    QuadraticViscous {
        /// `c`, s^2/um.
        coefficient: f64,
    },
    /// A spring on a yielding base: `y + k (y - b/2)^3/(250 um)^2 = x`, `b` follows `y` within 30 ms.
    CubicSpring {
        /// `k`.
        coefficient: f64,
    },
    /// A mode inside the band that takes a share of the motion.
    SecondMode {
        /// Its frequency, Hz.
        frequency_hz: f64,
        /// Its share.
        share: f64,
    },
}

/// Displacement at which stiffening counts fully, um.
const REFERENCE_UM: f64 = 250.0;

impl Mechanics {
    /// Turns free motion into that of the sensor's target, um.
    pub fn apply(self, dt_s: f64, signal: &mut [f64]) {
        match self {
            Self::Resonance { frequency_hz, damping_ratio } => {
                let mut first = Mode::new(frequency_hz, damping_ratio, dt_s, signal[0]);
                let mut second = Mode::new(2.7 * frequency_hz, damping_ratio, dt_s, signal[0]);
                for x in signal {
                    *x = 0.95 * first.step(*x) + 0.05 * second.step(*x);
                }
            }
            Self::Backlash { width_um } => {
                let mut plays = [0.8, 1.0, 1.2].map(|factor| (0.5 * factor * width_um, signal[0]));
                for x in signal {
                    for (half, y) in &mut plays {
                        *y = y.clamp(*x - *half, *x + *half);
                    }
                    *x = plays.iter().map(|(_, y)| y).sum::<f64>() / 3.0;
                }
            }
            Self::Friction { width_um } => friction(width_um, dt_s, signal),
            Self::Load { ratio } => {
                for x in signal {
                    *x = loaded(ratio, *x);
                }
            }
            Self::QuadraticViscous { coefficient } => {
                // Implicit midpoint rule: c |v| v + y + v dt/2 = x in the middle of the step.
                let (mut y, mut from) = (signal[0], signal[0]);
                let half_s = 0.5 * dt_s;
                for x in signal {
                    let gap: f64 = 0.5 * (from + *x) - y;
                    let root = (half_s * half_s + 4.0 * coefficient * gap.abs()).sqrt();
                    y += dt_s * 2.0 * gap / (half_s + root);
                    from = *x;
                    *x = y;
                }
            }
            Self::CubicSpring { coefficient } => {
                let decay = (-dt_s / 0.03).exp();
                let mut base = signal[0];
                for x in signal {
                    // The base creeps after the target: only the difference strains the spring.
                    let stiffness = coefficient / REFERENCE_UM.powi(2);
                    let mut y = *x;
                    for _ in 0..8 {
                        let strain = y - 0.5 * base;
                        let miss = y + stiffness * strain.powi(3) - *x;
                        y -= miss / (1.0 + 3.0 * stiffness * strain * strain);
                    }
                    base = y + (base - y) * decay;
                    *x = y;
                }
            }
            Self::SecondMode { frequency_hz, share } => {
                let mut mode = Mode::new(frequency_hz, 0.03, dt_s, signal[0]);
                for x in signal {
                    *x = (1.0 - share) * *x + share * mode.step(*x);
                }
            }
        }
    }

    /// Stiffness ratio of the load at a displacement; zero without one.
    pub fn load_ratio(self, y_um: f64) -> f64 {
        match self {
            Self::Load { ratio } => ratio * (1.0 + 0.1 * (y_um / REFERENCE_UM).powi(2)),
            _ => 0.0,
        }
    }
}

fn loaded(ratio: f64, x: f64) -> f64 {
    let mut y = x / (1.0 + ratio);
    for _ in 0..6 {
        y = x / (1.0 + ratio * (1.0 + 0.1 * (y / REFERENCE_UM).powi(2)));
    }
    y
}

/// Of one step with `q = sgn z/g` held below 1 and `X = |x1 - x0|/g`, the bristles `c` times as stiff:
///
/// ```text
/// dq/dX = c (1-q)/(1 + c (1-q))   =>   w + ln(w)/c falls by X,   w = 1 - q
/// ```
fn friction(width_um: f64, dt_s: f64, signal: &mut [f64]) {
    const BRISTLES: f64 = 8.0;
    let (mut z, mut from) = (0.0, signal[0]);
    for x in signal {
        let travel = *x - from;
        from = *x;
        let speed = travel / dt_s / 2000.0;
        let limit = 0.5 * width_um * (1.0 + 0.15 * (-speed * speed).exp());
        if travel.abs() > 0.0 {
            let q = (travel.signum() * z / limit).min(1.0 - 1e-12);
            let start = (1.0 - q).ln();
            let goal = start.exp() + start / BRISTLES - travel.abs() / limit;
            // v = ln w: the left side bends one way, so the steps come from one side
            let mut v = start;
            for _ in 0..60 {
                let step = (v.exp() + v / BRISTLES - goal) / (v.exp() + 1.0 / BRISTLES);
                v -= step;
                if step.abs() < 1e-14 {
                    break;
                }
            }
            z = travel.signum() * limit * (1.0 - v.exp());
        }
        *x -= z;
    }
}

/// `y'' + 2 zeta w y' + w^2 y = w^2 x`, stepped exactly while `x` runs in straight lines.
///
/// ```text
/// particular: y_p = x - 2 zeta b/w, b = dx/dt;   the rest e = y - y_p decays with
/// e(t) = exp(-zeta w t) (e0 cos w_d t + (e0' + zeta w e0)/w_d sin w_d t)
/// ```
#[derive(Debug, Clone, Copy)]
struct Mode {
    dt_s: f64,
    omega: f64,
    zeta: f64,
    turn: [f64; 4],
    input: f64,
    y: f64,
    speed: f64,
}

impl Mode {
    fn new(frequency_hz: f64, zeta: f64, dt_s: f64, rest: f64) -> Self {
        let omega = std::f64::consts::TAU * frequency_hz;
        let damped = omega * (1.0 - zeta * zeta).sqrt();
        let (s, c) = (damped * dt_s).sin_cos();
        let decay = (-zeta * omega * dt_s).exp();
        let turn = [
            decay * (c + zeta * omega / damped * s),
            decay * s / damped,
            -decay * omega * omega / damped * s,
            decay * (c - zeta * omega / damped * s),
        ];
        Self { dt_s, omega, zeta, turn, input: rest, y: rest, speed: 0.0 }
    }

    fn step(&mut self, input: f64) -> f64 {
        let slope = (input - self.input) / self.dt_s;
        let shift = 2.0 * self.zeta * slope / self.omega;
        let (e, v) = (self.y - (self.input - shift), self.speed - slope);
        self.y = input - shift + self.turn[0] * e + self.turn[1] * v;
        self.speed = slope + self.turn[2] * e + self.turn[3] * v;
        self.input = input;
        self.y
    }
}
