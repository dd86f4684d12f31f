//! Files that a scene or a mesh names: in the folder of what is opened, and outside of it with `--allow-outside`.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const MESH: &str = "usemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
const OUTSIDE: &str = "is not in the folder of the file that was opened, or below it; move it there, or allow it with --allow-outside";

/// A folder with the folders `scene`, which has scenes and meshes, and `beside`.
fn home() -> TempDir {
    let home = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = home.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    let scene = |mesh: &str| {
        format!("[camera]\neye = [0, 0, 3]\nimage = [16, 12]\n[[object]]\nmesh = '{mesh}'\n")
    };
    write("beside/a.obj", &format!("mtllib materials/a.mtl\n{MESH}"));
    write("beside/materials/a.mtl", "newmtl red\nKd 1 0 0\nmap_Kd ../red.png\n");
    write("scene/outside.toml", &scene("../beside/a.obj"));
    write("scene/absolute.toml", &scene(&home.path().join("scene/in/a.obj").display().to_string()));
    write("scene/inside.toml", &scene("in/a.obj"));
    write("scene/in/a.obj", &format!("mtllib ../materials/a.mtl\n{MESH}"));
    write("scene/materials/a.mtl", "newmtl red\nKd 1 0 0\nmap_Kd ../red.png\n");
    write("scene/b.obj", &format!("mtllib ../beside/materials/a.mtl\n{MESH}"));
    write("scene/c.obj", &format!("mtllib c.mtl\n{MESH}"));
    write("scene/c.mtl", "newmtl red\nKd 1 0 0\nmap_Kd ../beside/red.png\n");
    for folder in ["beside", "scene"] {
        image::RgbImage::from_pixel(1, 1, image::Rgb([255, 0, 0]))
            .save(home.path().join(folder).join("red.png"))
            .unwrap();
    }
    home
}

fn bothways(folder: &Path, args: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("bothways")
        .unwrap()
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .args(args)
        .assert()
}

#[test]
fn a_mesh_outside_of_the_scene_is_refused_unless_it_is_allowed() {
    let home = home();
    let scene = home.path().join("scene");
    let says = format!("\"../beside/a.obj\" {OUTSIDE}");
    let unwrapped = |text: &str| -> String {
        text.replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let refused = bothways(&scene, &["outside.toml", "-o", "out"]).code(2);
    let said = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
    assert!(unwrapped(&said).contains(&says), "{said}");
    assert!(said.starts_with("error: "), "{said}");
    assert!(!scene.join("out").exists());
    bothways(&scene, &["outside.toml", "-o", "out", "--allow-outside"]).code(0).stderr("");
    // Every command that opens a scene takes the option.
    for command in [
        "pixel outside.toml 5 5",
        "camera outside.toml",
        "scenes outside.toml",
        "export outside.toml --as ply",
    ] {
        let words: Vec<&str> = command.split(' ').collect();
        bothways(&scene, &words).code(2).stderr(contains("--allow-outside"));
        let allowed = [&words[..], &["--allow-outside"]].concat();
        bothways(&scene, &allowed).code(0).stderr(contains("--allow-outside").not());
    }
}

#[test]
fn what_stays_in_the_folder_of_the_scene_is_read_from_anywhere_in_it() {
    let home = home();
    let scene = home.path().join("scene");
    for name in ["inside.toml", "absolute.toml"] {
        bothways(&scene, &[name, "-o", "out"]).code(0).stderr("");
        let from_afar = format!("scene/{name}");
        bothways(home.path(), &[&from_afar, "-o", "out"]).code(0).stderr("");
    }
    // The mesh alone has a folder of its own, which its materials are not in.
    let says = "the material file \"../materials/a.mtl\" is outside of its folder, which takes --allow-outside; what needs \
                it is drawn in light grey";
    bothways(&scene, &["in/a.obj", "-o", "out"]).code(0).stderr(contains(says));
    bothways(&scene, &["in/a.obj", "-o", "out", "--allow-outside"]).code(0).stderr("");
}

#[test]
fn materials_and_pictures_outside_are_left_out_with_a_warning() {
    let home = home();
    let scene = home.path().join("scene");
    let says = "b.obj: the material file \"../beside/materials/a.mtl\" is outside of its folder";
    bothways(&scene, &["b.obj", "-o", "out"]).code(0).stderr(contains(says));
    let says = "c.mtl:3: the picture \"../beside/red.png\" is outside of its folder, which takes --allow-outside; what has it \
                as its texture is drawn without";
    bothways(&scene, &["c.obj", "-o", "out"]).code(0).stderr(contains(says));
    for name in ["b.obj", "c.obj"] {
        bothways(&scene, &[name, "-o", "out", "--allow-outside"]).code(0).stderr("");
    }
    // A picture that a scene names is no less than its mesh.
    let texture = "[material.m]\ntexture = '../beside/red.png'\n[[object]]\nmaterial = 'm'\nsphere = { center = [0, 0, 0], radius = 1 }\n";
    fs::write(scene.join("texture.toml"), texture).unwrap();
    bothways(&scene, &["texture.toml", "-o", "picture"])
        .code(2)
        .stderr(contains("--allow-outside"));
    assert!(!scene.join("picture").exists());
    let small = ["texture.toml", "-o", "picture", "--size", "8x6", "--allow-outside"];
    bothways(&scene, &small).code(0).stderr("");
}

#[test]
fn a_link_that_leads_outside_is_refused_too() {
    let home = home();
    let scene = home.path().join("scene");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(home.path().join("beside/a.obj"), scene.join("in/link.obj"))
            .unwrap();
        fs::write(scene.join("link.toml"), "[[object]]\nmesh = 'in/link.obj'\n").unwrap();
        bothways(&scene, &["link.toml", "-o", "out"]).code(2).stderr(contains("--allow-outside"));
        // Whether the file exists or not, the answer is the same.
        fs::write(scene.join("no.toml"), "[[object]]\nmesh = '../no-such.obj'\n").unwrap();
        bothways(&scene, &["no.toml", "-o", "out"]).code(2).stderr(contains("--allow-outside"));
        bothways(&scene, &["no.toml", "-o", "out", "--allow-outside"])
            .code(2)
            .stderr(contains("there is no such file").and(contains("--allow-outside").not()));
    }
}
