//! `slides` replaces what an earlier run wrote, and nothing else.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use predicates::str::contains;
use std::fs;

fn slides(home: &tempfile::TempDir) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).args(["slides", "canonical", "--no-films", "-o", "talk"]);
    command
}

#[test]
fn a_folder_with_a_readme_of_its_own_is_refused_before_anything_is_drawn() {
    let home = tempfile::tempdir().unwrap();
    fs::create_dir(home.path().join("talk")).unwrap();
    let own = home.path().join("talk/README.md");
    fs::write(&own, "my own words").unwrap();
    slides(&home).assert().code(2).stderr(contains(
        "talk/README.md is not of an earlier run of slides, and would be replaced; choose another folder with -o",
    ));
    assert_eq!(fs::read_to_string(own).unwrap(), "my own words");
    assert_eq!(fs::read_dir(home.path().join("talk")).unwrap().count(), 1);
}

#[test]
fn a_later_set_removes_the_slides_of_the_earlier_one() {
    let home = tempfile::tempdir().unwrap();
    let talk = home.path().join("talk");
    fs::create_dir(&talk).unwrap();
    fs::write(
        talk.join("slides.txt"),
        "# what bothways slides wrote here\n99-old.svg\n../kept.svg\nkept.svg\n",
    )
    .unwrap();
    for name in
        ["talk/99-old.svg", "talk/kept.svg", "kept.svg", "talk/README.md", "talk/index.html"]
    {
        fs::write(home.path().join(name), "earlier").unwrap();
    }
    slides(&home).args(["--theme", "light"]).assert().code(0);
    assert!(!talk.join("99-old.svg").exists());
    assert!(talk.join("kept.svg").exists() && home.path().join("kept.svg").exists());
    let list = fs::read_to_string(talk.join("slides.txt")).unwrap();
    let page = fs::read_to_string(talk.join("index.html")).unwrap();
    assert!(list.lines().count() > 15);
    for file in list.lines().skip(1) {
        assert!(
            page.contains(file) && fs::metadata(talk.join(file)).unwrap().len() > 1000,
            "{file}"
        );
    }
}
