//! Packages, licences of data and the version of the model: as they are, and each rule broken.
#![expect(
    clippy::disallowed_methods,
    reason = "tests write the folders that they try the rules on"
)]

use std::path::Path;

use xtask::release::packages::{Manifest, Needed, included, licences, manifests, outside};
use xtask::release::{data_licences, model_version};
use xtask::{files, workspace};

#[test]
fn the_version_of_the_model_is_that_of_the_goldens() {
    assert_eq!(model_version::check(&workspace::root()).unwrap(), Vec::<String>::new());
}

/// Goldens that moved ask for another version; a version without a row, and a row without a version, are faults.
#[test]
fn goldens_that_changed_raise_the_version() {
    let list = "version\tgoldens\twhat moved\n1\tab\tfirst\n2\tcd\twake\n";
    let faults =
        |list: &str, goldens: &str, version: &str| model_version::faults(list, goldens, version);
    assert!(faults(list, "cd", "0.1.0+model.2").is_empty());
    // a version for what no golden sees
    assert!(faults(&format!("{list}3\tcd\tstall\n"), "cd", "0.1.0+model.3").is_empty());
    for (list, goldens, version, word) in [
        (list.to_owned(), "ef", "0.1.0+model.2", "raise the count"),
        (list.to_owned(), "cd", "0.1.0+model.1", "must be one"),
        (list.to_owned(), "cd", "0.1.0", "must be one"),
        (format!("{list}3\tef\t\n"), "ef", "0.1.0+model.3", "say what moved"),
        (format!("{list}4\tef\ta\n"), "ef", "0.1.0+model.3", "count 4, expected 3"),
        (format!("{list}3\tab\ta\n"), "ab", "0.1.0+model.3", "goldens of version 1"),
        (format!("{list}3\tef\n"), "ef", "0.1.0+model.3", "expected count, hash"),
    ] {
        let said = faults(&list, goldens, version);
        assert!(said.iter().any(|fault| fault.contains(word)), "{word}: {said:?}");
    }
    // every byte of a golden counts
    let place = tempfile::tempdir().unwrap();
    let hash = || model_version::hash_of_goldens(place.path()).unwrap();
    std::fs::write(place.path().join("a.ron"), "1").unwrap();
    let first = hash();
    std::fs::write(place.path().join("note.tsv"), "1").unwrap();
    assert_eq!(hash(), first);
    std::fs::write(place.path().join("a.ron"), "2").unwrap();
    assert_ne!(hash(), first);
}

#[test]
fn every_folder_of_data_says_whence_it_is_and_the_page_says_the_same() {
    let (page, faults) = data_licences::fresh(&workspace::root()).unwrap();
    assert_eq!(faults, Vec::<String>::new());
    let there = files::read(&workspace::root().join(data_licences::PAGE)).unwrap();
    assert!(page == there, "stale: run `cargo xtask data-licences`");
    for folder in
        ["measured/forc", "reference/rotor", "bench/apa500l_synthetic", "instruments", "mat"]
    {
        assert!(page.contains(&format!("| [`{folder}`]")), "{folder}");
    }
}

#[test]
fn a_folder_of_data_without_origin_or_licence_is_a_fault() {
    let place = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = place.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    let faults = || data_licences::collect(place.path()).unwrap().1;
    write("measured/a/data.csv", "1");
    assert!(faults()[0].contains("fixtures/measured/a/SOURCE.md"), "{:?}", faults());
    write("measured/a/SOURCE.md", "# A\n\n- Origin: someone.\n");
    assert!(faults()[0].contains("under which licence"), "{:?}", faults());
    write("measured/a/SOURCE.md", "# A\n\n- Licence: as the program.\n");
    assert!(faults()[0].contains("no `- Origin:`"), "{:?}", faults());
    write(
        "measured/a/SOURCE.md",
        "# A\n\n- Origin: someone.\n- Licence: MIT, text in `LICENSE`.\n",
    );
    assert!(faults()[0].contains("asks for its text"), "{:?}", faults());
    write("measured/a/LICENSE", "MIT");
    assert!(faults().is_empty(), "{:?}", faults());
    // a group speaks for the folders that it names
    write("bench/b/data.csv", "1");
    write("bench/SOURCE.md", "# B\n\n- Origin: a generator.\n- Licence: as the program.\n\n`c`\n");
    assert_eq!(faults().len(), 1, "{:?}", faults());
    write("bench/SOURCE.md", "# B\n\n- Origin: a generator.\n- Licence: as the program.\n\n`b`\n");
    assert!(faults().is_empty(), "{:?}", faults());
    write("new/data.csv", "1");
    assert!(faults()[0].contains("fixtures/new"), "{:?}", faults());
}

#[test]
fn the_manifests_are_complete() {
    let root = workspace::root();
    let members = manifests(&root).unwrap();
    assert!(members.iter().filter(|own| own.is_published()).count() > 20);
    for member in members {
        let folder = Path::new(&member.manifest_path).parent().unwrap();
        let folder = folder.strip_prefix(&root).unwrap().display().to_string();
        assert_eq!(member.faults(&format!("{folder}/")), Vec::<String>::new());
        if member.is_published() {
            assert_eq!(
                licences(&root, &root.join(&folder)).unwrap(),
                Vec::<String>::new(),
                "{folder}"
            );
        }
    }
}

/// The text of the licence is in every package, and is that of the repository.
#[test]
fn a_package_without_the_text_of_its_licence_is_a_fault() {
    let place = tempfile::tempdir().unwrap();
    let (root, package) = (place.path(), place.path().join("package"));
    std::fs::create_dir_all(&package).unwrap();
    for name in ["LICENSE-MIT", "LICENSE-APACHE"] {
        std::fs::write(root.join(name), name).unwrap();
    }
    assert_eq!(licences(root, &package).unwrap().len(), 2, "neither is there");
    for name in ["LICENSE-MIT", "LICENSE-APACHE"] {
        std::fs::write(package.join(name), name).unwrap();
    }
    assert!(licences(root, &package).unwrap().is_empty());
    std::fs::write(package.join("LICENSE-MIT"), "LICENSE").unwrap();
    let said = licences(root, &package).unwrap();
    assert!(said.len() == 1 && said[0].contains("LICENSE-MIT is not that of"), "{said:?}");
}

#[test]
fn a_manifest_without_a_part_is_a_fault() {
    let whole = Manifest {
        name: "a".into(),
        description: Some("a".into()),
        license: Some("MIT".into()),
        readme: Some("README.md".into()),
        rust_version: Some("1.95".into()),
        keywords: vec!["a".into()],
        categories: vec!["science".into()],
        ..Manifest::default()
    };
    assert!(whole.faults("crates/a/").is_empty());
    let needed = |kind: Option<&str>| Needed {
        name: "b".into(),
        req: "*".into(),
        kind: kind.map(str::to_owned),
        path: Some("b".into()),
    };
    // a registry never sees what tests alone need
    let tested = Manifest { dependencies: vec![needed(Some("dev"))], ..whole.clone() };
    assert!(tested.faults("crates/a/").is_empty());
    for (broken, word) in [
        (Manifest { description: None, ..whole.clone() }, "no description"),
        (Manifest { license: None, ..whole.clone() }, "no license"),
        (Manifest { readme: None, ..whole.clone() }, "no readme"),
        (Manifest { rust_version: None, ..whole.clone() }, "no rust-version"),
        (Manifest { keywords: vec!["a".into(); 6], ..whole.clone() }, "no keywords"),
        (Manifest { categories: vec![], ..whole.clone() }, "no categories"),
        (Manifest { dependencies: vec![needed(None)], ..whole.clone() }, "without a version"),
        (Manifest { publish: Some(vec![]), ..whole.clone() }, "remove `publish = false`"),
    ] {
        let said = broken.faults("crates/a/");
        assert!(said.len() == 1 && said[0].contains(word), "{word}: {said:?}");
    }
    assert!(whole.faults("tests/a/").is_empty());
    assert!(whole.faults("tests/e2e/")[0].contains("add `publish = false`"));
}

#[test]
fn an_included_file_outside_of_the_package_is_a_fault() {
    let text = "const A: &str = include_str!(\"a.md\");\nconst B: &[u8] = include_bytes!(\n    \"../b\"\n);\n\
                macro_rules! c { ($p:literal) => { include_str!($p) }; }\n";
    assert_eq!(included(text), [(1, "a.md".to_owned()), (2, "../b".to_owned())]);
    let place = tempfile::tempdir().unwrap();
    let package = place.path().join("package");
    std::fs::create_dir_all(package.join("src")).unwrap();
    std::fs::write(package.join("src/lib.rs"), text).unwrap();
    std::fs::write(package.join("src/a.md"), "a").unwrap();
    std::fs::write(place.path().join("b"), "b").unwrap();
    let found: Vec<String> =
        outside(&package).unwrap().into_iter().map(|own| own.included).collect();
    // it is not there
    assert_eq!(found, ["../b"]);
    std::fs::write(package.join("b"), "b").unwrap();
    assert!(outside(&package).unwrap().is_empty());
    // it is there, but not inside
    std::fs::write(package.join("src/lib.rs"), text.replace("../b", "../../b")).unwrap();
    assert_eq!(outside(&package).unwrap().len(), 1);
}
