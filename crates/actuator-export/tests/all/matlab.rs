//! MATLAB: by Octave where there is one.

use crate::common::{
    Named, amplitude, bench, can_check, folder, largest_difference, laws, read_numbers, run,
    stages, wanted, write, write_numbers,
};
use actuator_export::{Target, export};

const SCRIPT: &str = "
x = fread(fopen('in', 'rb'), Inf, 'double')';
w = fread(fopen('wanted', 'rb'), Inf, 'double')';
names = strsplit(strtrim(fileread('names')), ' ');
for k = 1:numel(names)
    flap = feval(names{k});
    y = flap.simulate(x);
    volts = flap.invert(w);
    out = double(flap.out_of_reach);
    f = fopen(['out_' names{k}], 'wb');
    fwrite(f, [y, volts, out], 'double');
    fclose(f);
end
";

#[test]
fn octave_gives_the_numbers_of_the_model() {
    if !can_check("octave") {
        return;
    }
    let step_s = 1e-3;
    let mix = bench().into_iter().find(|run| run.id.starts_with("mix")).unwrap();
    let volts = &mix.volts[1000..1120];
    let wanted: Vec<f64> = wanted(1.5, 0.5, step_s).into_iter().take(120).collect();
    let models: Vec<Named> = laws().into_iter().chain(stages()).collect();
    let folder = folder("matlab");
    for named in &models {
        write(&folder, named, step_s, Target::Matlab);
    }
    let names: Vec<&str> = models.iter().map(|named| named.name).collect();
    std::fs::write(folder.join("names"), names.join(" ")).unwrap();
    std::fs::write(folder.join("script.m"), SCRIPT).unwrap();
    write_numbers(&folder.join("in"), volts);
    write_numbers(&folder.join("wanted"), &wanted);
    run(&folder, "octave-cli", &["--no-gui", "--quiet", "--norc", "script.m"]);
    for Named { name, model } in &models {
        let numbers = read_numbers(&folder.join(format!("out_{name}")));
        let (got, inverse) = numbers.split_at(volts.len());
        let (commands, flags) = inverse.split_at(wanted.len());
        let expected = model.simulate(volts, step_s).unwrap().output_deg;
        let off = largest_difference(got, &expected) / amplitude(&expected);
        let moved = model.simulate(commands, step_s).unwrap().output_deg;
        let beside = largest_difference(&moved, &wanted) / amplitude(&wanted);
        println!("{name}: forward {off:.1e}, inverse {beside:.1e} of the amplitude");
        assert!(off <= 1e-12, "{name}: {off}");
        // fewer samples a period than elsewhere
        assert!(beside <= 0.02 || *name == "with_delay", "{name}: {beside}");
        assert!(flags.iter().all(|flag| *flag < 0.5), "{name}");
    }
}

#[test]
fn nothing_is_left_unfilled() {
    for named in laws().iter().chain(&stages()) {
        for target in [Target::Matlab, Target::Python] {
            for (file, text) in export(&named.model, named.name, 1e-3, target).unwrap() {
                for word in ["{{", "}}", "\t", " \n", "\n\n\n\n"] {
                    assert!(!text.contains(word), "{file}: {word:?}");
                }
                let longest = text.lines().map(str::len).max().unwrap();
                assert!(longest <= 120, "{file}: {longest}");
            }
        }
    }
}
