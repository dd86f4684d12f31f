//! Primitives that are missing and not counted, and numberings that look like that.

use super::*;
use crate::diff::why::draw::draw_those;

/// The file of a renderer that does not read some primitives, and gives the others ids without them.
fn without(view: &View, is_missing: impl Fn(u32) -> bool) -> Buffer<'static> {
    let drawn = draw_those(view, &Convention::default(), Rows::ALL, |id| !is_missing(id));
    let mut numbers = Vec::new();
    let mut next = 0;
    for id in 0..u32::try_from(view.scene.primitive_count()).unwrap() {
        numbers.push(next);
        next += u64::from(!is_missing(id));
    }
    let ids = drawn.ids.iter().map(|&id| (id != NO_PRIMITIVE).then(|| numbers[id as usize]));
    Buffer::new(view.camera.image(), 1, Content::Ids(ids.collect()))
}

fn found(view: &View, file: &Buffer) -> Vec<Explanation> {
    match find_conventions(view, file).unwrap().finding {
        Finding::Explained(found) => found,
        _ => Vec::new(),
    }
}

/// The ids of the object with most primitives.
fn largest(view: &View) -> std::ops::Range<u32> {
    let objects = (0..view.scene.objects().len()).map(|object| view.scene.ids_of(object));
    let ids = objects.max_by_key(|ids| ids.end - ids.start).unwrap();
    u32::try_from(ids.start).unwrap()..u32::try_from(ids.end).unwrap()
}

#[test]
fn faces_that_are_not_read_are_named() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let mesh = largest(view);
        let all = view.scene.primitive_count();
        assert!(u64::from(mesh.end) < all, "{mesh:?} of {all}");
        let (first, last) = (mesh.start, mesh.end - 1);
        for gone in [vec![first], vec![last], vec![first, last]] {
            let found = found(view, &without(view, |id| gone.contains(&id)));
            let [one] = &found[..] else { panic!("{gone:?}: {}", found.len()) };
            let count: u32 = one.missing.iter().map(|one| one.count).sum();
            assert_eq!((count as usize, one.remaining), (gone.len(), 0), "{:?}", one.missing);
            for id in gone {
                let holds = |[first, last]: [u32; 2]| (first..=last).contains(&id);
                assert!(one.missing.iter().any(|one| holds(one.among)), "{:?}", one.missing);
            }
            let said = one.sentences("B", view.camera).join("; ");
            assert!(said.contains("also the first and the last one?"), "{said}");
        }
    });
}

#[test]
fn second_triangles_of_quads_that_are_not_read_are_named() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let mesh = largest(view);
        // All second ones; and three of four of them, where some faces are triangles.
        for (every, of_all) in [(2, true), (8, false)] {
            let is_missing = |id: u32| {
                let within = id.wrapping_sub(mesh.start);
                mesh.contains(&id) && within % 2 == 1 && (every == 2 || within % every != 1)
            };
            let found = found(view, &without(view, is_missing));
            let [one] = &found[..] else { panic!("{every}: {}", found.len()) };
            assert!(one.remaining * 50 <= one.explained, "{} left", one.remaining);
            let [missing] = &one.missing[..] else { panic!("{:?}", one.missing) };
            let is_every_second = missing.scattered.map(|one| one.is_every_second);
            assert_eq!(is_every_second, Some(of_all), "{missing:?}");
            let said = one.sentences("B", view.camera).join("; ");
            assert!(said.contains("of each quad, does it read the first triangle alone"), "{said}");
        }
    });
}

#[test]
fn what_is_numbered_otherwise_is_not_missing() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let truth = draw(view, &Convention::default(), Rows::ALL).ids;
        let (mesh, all) = (largest(view), u32::try_from(view.scene.primitive_count()).unwrap());
        let numbered = |number: &dyn Fn(u32) -> u32| {
            let ids = truth.iter().map(|&id| (id != NO_PRIMITIVE).then(|| number(id).into()));
            found(view, &Buffer::new(view.camera.image(), 1, Content::Ids(ids.collect())))
        };
        let reversed = |id: u32| {
            if mesh.contains(&id) { mesh.start + mesh.end - 1 - id } else { id }
        };
        // The first half comes last.
        let turned = |id: u32| (id + all / 2) % all;
        let moved = |id: u32| id + if id < mesh.end { 0 } else { 5 };
        let numberings: [(&str, &dyn Fn(u32) -> u32); 3] =
            [("reversed", &reversed), ("turned", &turned), ("moved", &moved)];
        for (name, numbering) in numberings {
            for one in numbered(numbering) {
                assert!(one.missing.is_empty(), "{name}: {:?}", one.missing);
            }
        }
        let reversed = numbered(&reversed);
        let is_another_order = |one: &Explanation| one.encoding.ids == IdEncoding::OneToOne;
        assert!(!reversed.is_empty() && reversed.iter().all(is_another_order));
    });
}

#[test]
fn holes_are_no_numbering_of_another_order() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        // A third of the triangles is lost, and the others have numbers in no order.
        let all = u32::try_from(view.scene.primitive_count()).unwrap();
        let convention = Convention::default();
        let drawn = draw_those(view, &convention, Rows::ALL, |id| id % 3 != 0);
        let number = |id: u32| u64::from(all - 1 - id) * 7 % u64::from(all);
        let ids = drawn.ids.iter().map(|&id| (id != NO_PRIMITIVE).then(|| number(id)));
        let file = Buffer::new(view.camera.image(), 1, Content::Ids(ids.collect()));
        let is_another_order = |one: &Explanation| {
            one.encoding.ids == IdEncoding::OneToOne && one.convention == convention
        };
        assert!(!found(view, &file).iter().any(is_another_order));
    });
}
