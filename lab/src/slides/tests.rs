use super::*;
use crate::scenes;

fn small(name: &str) -> LoadedScene {
    let mut loaded = scenes::load(name).unwrap();
    loaded.camera.image = [16, 12];
    loaded
}

#[test]
fn every_slide_of_a_lecture_is_drawn_and_no_text_overlaps() {
    let scenes = [small("overlap"), small("canonical")];
    let deck = Deck::new(&scenes, Theme::Dark, false).unwrap();
    assert!(deck.slides().len() > 18);
    for slide in deck.slides() {
        match deck.draw(slide).unwrap() {
            Content::Drawing(drawing) => {
                assert!(drawing.faults().is_empty(), "{}: {:?}", slide.file, drawing.faults())
            }
            Content::Film(_) => panic!("{} is a film", slide.file),
        }
    }
}

#[test]
fn a_page_names_every_file_once_and_loads_nothing_else() {
    let scenes = [small("lecture"), small("ties")];
    let deck = Deck::new(&scenes, Theme::Light, true).unwrap();
    let page = deck.page();
    for slide in deck.slides() {
        assert_eq!(page.matches(&format!("\"{}\"", slide.file)).count(), 1, "{}", slide.file);
        assert!(!slide.caption.is_empty() && !slide.notes.is_empty());
        assert!(deck.readme().contains(&slide.file));
    }
    assert!(!page.contains("http://") && !page.contains("https://") && !page.contains("{{"));
    assert!(deck.slides().iter().any(|slide| slide.file.ends_with("film-textbook.gif")));
}

#[test]
fn slides_that_a_scene_has_nothing_for_are_left_out() {
    let plane = crate::common::Shape::Plane(crate::common::Plane {
        point: crate::common::glam::Vec3::NEG_Y,
        normal: crate::common::glam::Vec3::Y,
    });
    let scene = crate::common::Scene::new(vec![plane.into()]).unwrap();
    let floor = LoadedScene { name: "floor".into(), scene, ..small("canonical") };
    let scenes = [floor];
    let deck = Deck::new(&scenes, Theme::Dark, false).unwrap();
    let of_floor = |what: &str| deck.slides().iter().any(|slide| slide.file.contains(what));
    assert!(!of_floor("edge-functions") && !of_floor("hierarchy"));
    assert!(of_floor("camera-perspective") && of_floor("ties"));
    for slide in deck.slides() {
        deck.draw(slide).unwrap_or_else(|error| panic!("{}: {error}", slide.file));
    }
}
