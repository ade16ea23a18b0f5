//! Python: the class without `NumPy`, the array functions where there is `NumPy`.

use crate::common::{
    Named, amplitude, bench, by_time_step, can_check, folder, largest_difference, laws,
    read_numbers, run, stages, there_is, wanted, write, write_numbers,
};
use actuator_export::Target;

/// Reads numbers, runs them through the class of a module and, where `NumPy` is, through its array functions.
const SCRIPT: &str = r#"
import array, importlib, os, sys

def numbers(path):
    values = array.array("d")
    with open(path, "rb") as file:
        values.frombytes(file.read())
    return values.tolist()

mode, names = sys.argv[1], sys.argv[2:]
x = numbers("in")
try:
    import numpy
except ImportError:
    numpy = None
for name in names:
    flap = importlib.import_module(name).Actuator(x[0]) if mode == "forward" else importlib.import_module(name).Actuator()
    y = array.array("d")
    if mode == "forward":
        y.append(flap.output_deg)
        y.extend(flap.step(volt) for volt in x[1:])
        if numpy:
            assert (flap.simulate(numpy.array(x)) == numpy.array(y)).all(), name
    else:
        volt = flap.rest_volt(x[0])
        flap.inverse_start(volt)
        y.append(volt)
        for deg in x[1:]:
            y.append(flap.inverse_step(deg))
            assert not flap.out_of_reach, name
        if numpy:
            assert (flap.invert(numpy.array(x)) == numpy.array(y)).all(), name
            assert not flap.out_of_reach.any(), name
    with open("out_" + name, "wb") as file:
        y.tofile(file)
print("numpy" if numpy else "no numpy")
"#;

/// Samples of every run that Python is given: it is slow.
const SAMPLES: usize = 250;

#[test]
fn the_class_gives_the_numbers_of_the_model() {
    if !there_is("python3", &["--version"]) {
        println!("no python3 here: nothing tested");
        return;
    }
    let with_numpy = can_check("numpy");
    let models: Vec<Named> = laws().into_iter().chain(stages()).collect();
    let names: Vec<&str> = models.iter().map(|named| named.name).collect();
    let mut worst = 0.0_f64;
    for (group, (time_step_s, runs)) in by_time_step(bench()).into_iter().enumerate() {
        let folder = folder(&format!("python_{group}"));
        std::fs::write(folder.join("script.py"), SCRIPT).unwrap();
        for named in &models {
            write(&folder, named, time_step_s, Target::Python);
        }
        for bench_run in &runs {
            let middle = bench_run.volts.len() / 4;
            let volts = &bench_run.volts[middle..middle + SAMPLES];
            write_numbers(&folder.join("in"), volts);
            let arguments: Vec<&str> =
                ["script.py", "forward"].into_iter().chain(names.iter().copied()).collect();
            let printed = run(&folder, "python3", &arguments);
            for Named { name, model } in &models {
                let got = read_numbers(&folder.join(format!("out_{name}")));
                let expected = model.simulate(volts, time_step_s).unwrap().output_deg;
                let off = largest_difference(&got, &expected) / amplitude(&expected);
                assert!(off <= 1e-12, "{} {name}: {off}", bench_run.id);
                worst = worst.max(off);
            }
            assert_eq!(printed.trim(), if with_numpy { "numpy" } else { "no numpy" });
        }
    }
    println!("largest difference {worst:.1e} of the amplitude");
}

#[test]
fn the_inverse_moves_the_flap_as_wanted() {
    if !there_is("python3", &["--version"]) {
        println!("no python3 here: nothing tested");
        return;
    }
    let step_s = 5e-4;
    let models: Vec<Named> =
        laws().into_iter().chain(stages()).filter(|named| named.name != "with_delay").collect();
    let folder = folder("python_inverse");
    std::fs::write(folder.join("script.py"), SCRIPT).unwrap();
    for named in &models {
        write(&folder, named, step_s, Target::Python);
    }
    let wanted = wanted(1.5, 0.5, step_s);
    write_numbers(&folder.join("in"), &wanted);
    let mut arguments = vec!["script.py", "inverse"];
    arguments.extend(models.iter().map(|named| named.name));
    run(&folder, "python3", &arguments);
    for Named { name, model } in &models {
        let volts = read_numbers(&folder.join(format!("out_{name}")));
        let got = model.simulate(&volts, step_s).unwrap().output_deg;
        let off = largest_difference(&got, &wanted) / amplitude(&wanted);
        println!("{name}: {off:.1e} of the amplitude");
        assert!(off <= 5e-3, "{name}: {off}");
    }
}
