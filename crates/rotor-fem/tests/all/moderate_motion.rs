//! Free motion of the undamped rotating blade in a vacuum keeps its energy.
#![expect(clippy::unwrap_used, reason = "a test may fail by unwrapping")]

use crate::free_motion;

use free_motion::FreeMotion;
use rotor_fem::{
    BladeSpec, Joint, ModerateBlade, ModerateModel, ModerateSpec, RootSupport, StaticSettings,
    Twist,
};

/// A blade that couples everything, bent by a load that is then let go.
fn model() -> ModerateModel {
    let spec = ModerateSpec {
        mass_centre: (-0.004).into(),
        tension_centre: 0.003.into(),
        ..BladeSpec {
            root: RootSupport {
                feather: Joint::Spring { stiffness: 0.02 },
                ..RootSupport::CLAMPED
            },
            twist: Twist::Linear { rate_rad: -0.14 },
            pitch_rad: 0.14,
            precone_rad: 0.03,
            ..BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 200.0)
        }
        .into()
    };
    ModerateModel::new(ModerateBlade::new(spec).unwrap(), 3).unwrap()
}

/// Largest energy error in the first and in the last quarter, over the energy of the motion.
fn drift(time_step: f64, revolutions: f64) -> [f64; 2] {
    let model = model();
    let load = model.distributed_load(|x| [0.0, 0.01 * x, 0.04 * x * x, 0.0]);
    let none = load.clone() * 0.0;
    let settings = StaticSettings::default();
    let bent = model.static_state(&load, &settings).unwrap();
    let rest = model.static_state(&none, &settings).unwrap();
    let motion = FreeMotion::new(&model, time_step);
    let mut state = motion.at_rest(bent.dof);
    let start = motion.energy(&state).unwrap();
    let size = start - motion.energy(&motion.at_rest(rest.dof)).unwrap();
    assert!(size > 1e-4);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a step count")]
    let steps = (revolutions * std::f64::consts::TAU / time_step) as usize;
    let mut worst = [0.0_f64; 2];
    for step in 0..steps {
        state = motion.step(&state).unwrap();
        if step % 4 != 0 {
            continue;
        }
        let gap = (motion.energy(&state).unwrap() - start).abs() / size;
        if step < steps / 4 {
            worst[0] = worst[0].max(gap);
        } else if step >= 3 * steps / 4 {
            worst[1] = worst[1].max(gap);
        }
    }
    worst
}

#[test]
fn energy_stays_in_a_band_that_falls_with_the_square_of_the_step() {
    let steps = [0.08, 0.04, 0.02];
    let bands = steps.map(|step| drift(step, 4.0)[0]);
    for (k, pair) in bands.windows(2).enumerate() {
        let order = (pair[0] / pair[1]).log2();
        println!(
            "steps {} and {}: {:.3e}, {:.3e}, order {order:.2}",
            steps[k],
            steps[k + 1],
            pair[0],
            pair[1]
        );
        assert!((1.9..2.1).contains(&order), "{order}");
    }
    // bounded: after forty revolutions no worse than at the start
    let [first, last] = drift(0.08, 40.0);
    println!("forty revolutions: first quarter {first:.3e}, last quarter {last:.3e}");
    assert!(first < 1e-4 && last < 1.1 * first);
}
