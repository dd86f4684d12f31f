//! Pages of small comparisons: what is in them, and what is not.

use super::arrays::tests::read;
use super::*;
use crate::diff::foreign::{
    CompareOptions, Content, Covered, Picture, Pixels, compare, compare_with,
};
use crate::picture::NOTHING;
use serde_json::{Value, json};

/// A row of ids, or of the ids of some samples a pixel.
fn ids(samples: u32, ids: &[Option<u64>]) -> Buffer<'static> {
    let width = u32::try_from(ids.len()).unwrap() / samples.pow(2);
    Buffer::new([width, 1], samples, Content::Ids(ids.to_vec()))
}

fn distances(t: &[f64]) -> Buffer<'static> {
    let width = u32::try_from(t.len()).unwrap();
    Buffer::new([width, 1], 1, Content::Distances(t.to_vec()))
}

fn written(page: &Page) -> String {
    let mut html = Vec::new();
    page.write(&mut html).unwrap();
    String::from_utf8(html).unwrap()
}

/// The page of two buffers with ordinary names.
fn page_of(a: &Buffer, b: &Buffer) -> String {
    written(&Page::new(["a.npy", "b.npy"], [a, b], &compare(a, b).unwrap()).unwrap())
}

/// What is between the tags of the script with this id.
fn script<'a>(html: &'a str, id: &str) -> &'a str {
    let (_, rest) = html.split_once(&format!(" id=\"{id}\">")).unwrap_or_else(|| panic!("no {id}"));
    rest.split_once("</script>").unwrap().0
}

fn facts(html: &str) -> Value {
    serde_json::from_str(script(html, "facts")).unwrap()
}

/// The numbers of an array of four bytes each.
fn numbers(html: &str, id: &str, base: Option<&[u8]>) -> Vec<u32> {
    let bytes = read(script(html, id), 4, base);
    bytes.chunks_exact(4).map(|four| u32::from_le_bytes(four.try_into().unwrap())).collect()
}

#[test]
fn classes_become_groups_with_their_pixels() {
    let a = ids(1, &[Some(0), Some(1), None, Some(2), Some(9)]);
    let b = ids(1, &[Some(0), None, Some(3), Some(4), None]);
    let html = page_of(&a, &b);
    let facts = facts(&html);
    let groups = facts["groups"].as_array().unwrap();
    let names: Vec<&Value> = groups.iter().map(|group| &group["name"]).collect();
    assert_eq!(names, ["covered in A only", "covered in B only", "in both, other ids"]);
    assert_eq!(groups[0]["color"], json!([0xe6, 0x9f, 0x00]));
    assert_eq!(numbers(&html, "group-0", None), [1, 4]);
    assert_eq!(numbers(&html, "group-1", None), [2]);
    assert_eq!(numbers(&html, "group-2", None), [3]);
}

#[test]
fn the_third_class_names_what_it_may_be() {
    let picture = |pixel| {
        let pixels = Pixels::Bytes(vec![pixel]);
        Buffer::new([1, 1], 1, Content::Picture(Picture { pixels, covered: Covered::Unknown }))
    };
    let (a, b) = (picture([9, 9, 9, 255]), picture([99, 9, 9, 255]));
    let groups = Group::of_classes(&compare(&a, &b).unwrap());
    assert_eq!(groups[0].name, "other colours");
    assert_eq!(groups[0].explanation.as_deref(), Some("a colour beyond 2/255"));
    let (a, b) = (distances(&[1.0]), distances(&[2.0]));
    assert_eq!(Group::of_classes(&compare(&a, &b).unwrap())[0].name, "in both, other t");
}

#[test]
fn values_can_be_read_back() {
    let a = ids(2, &[Some(7), None, Some(8), Some(0), Some(1), Some(1), Some(1), Some(1)]);
    let b = ids(2, &[Some(7), None, Some(8), Some(4), None, Some(1), Some(1), Some(1)]);
    let html = page_of(&a, &b);
    let of_a = numbers(&html, "a-ids", None);
    assert_eq!(of_a, [7, u32::MAX, 8, 0, 1, 1, 1, 1]);
    // B is told by its difference from A.
    let bytes: Vec<u8> = of_a.into_iter().flat_map(u32::to_le_bytes).collect();
    let of_b = numbers(&html, "b-ids", Some(&bytes));
    assert_eq!(of_b, [7, u32::MAX, 8, 4, u32::MAX, 1, 1, 1]);
    let arrays = &facts(&html)["sides"][1]["arrays"];
    assert_eq!(*arrays, json!([{ "name": "ids", "kind": "u32", "from_a": true }]));
}

#[test]
fn numbers_take_as_many_bytes_as_they_need() {
    let single = distances(&[0.5, f64::NAN]);
    let double = distances(&[0.1, f64::NEG_INFINITY]);
    let html = page_of(&single, &double);
    let kinds = [0_usize, 1].map(|side| facts(&html)["sides"][side]["arrays"][0]["kind"].clone());
    assert_eq!(kinds, ["f32", "f64"]);
    let t = read(script(&html, "b-t"), 8, None);
    assert_eq!(t[..8], 0.1_f64.to_le_bytes());
    assert_eq!(t[8..], f64::INFINITY.to_le_bytes());
    let large = ids(1, &[Some(1 << 40)]);
    let html = page_of(&large, &large);
    assert_eq!(read(script(&html, "a-ids"), 8, None), (1_u64 << 40).to_le_bytes());
}

#[test]
fn normals_are_colors_and_values() {
    let normals = |x| Buffer::new([2, 1], 1, Content::Normals(vec![[x, 0.0, 1.0], [0.0; 3]]));
    let (a, b) = (normals(0.0), normals(-1.0));
    let html = page_of(&a, &b);
    let arrays = &facts(&html)["sides"][0]["arrays"];
    assert_eq!(arrays[0], json!({ "name": "normals", "kind": "f32x3", "from_a": false }));
    assert_eq!(read(script(&html, "a-normals"), 12, None)[8..12], 1.0_f32.to_le_bytes());
    let groups = &facts(&html)["groups"];
    assert_eq!(groups[0]["name"], "in both, other normals");
    assert_eq!(groups[0]["explanation"], "normals more than 0.1° apart");
    let [shown, _] = super::shown::shown([&a, &b]);
    assert_eq!(shown.picture.into_raw(), [[128, 128, 255], NOTHING].concat());
}

#[test]
fn what_is_allowed_to_differ_is_no_failure() {
    let (a, b) = (ids(1, &[Some(0), Some(1)]), ids(1, &[Some(0), None]));
    let options = CompareOptions { allowed_pixels: 1, ..CompareOptions::default() };
    let comparison = compare_with(&a, &b, &options).unwrap();
    let html = written(&Page::new(["a", "b"], [&a, &b], &comparison).unwrap());
    let verdict = "equal enough: they differ in 1 pixel of 2, at (0, 1)</h1>";
    assert!(html.contains(&format!("<h1 class=\"good\">{verdict}")));
    assert!(html.contains("<dt>intersection over union</dt><dd>0.5000</dd>"));
}

#[test]
fn a_hostile_text_does_nothing() {
    let hostile = "</script><script>alert(1)</script><!--\"'&\u{202e}{{data}}";
    let (a, b) = (ids(1, &[Some(0)]), ids(1, &[Some(1)]));
    let comparison = compare(&a, &b).unwrap();
    let mut page = Page::new([hostile, hostile], [&a, &b], &comparison).unwrap();
    page.groups[0].name = hostile.into();
    page.groups[0].explanation = Some(hostile.into());
    page.findings = vec![hostile.into()];
    page.figures = vec![(hostile.into(), hostile.into())];
    page.verdict = hostile.into();
    page.why = Some(hostile.into());
    let harmless = written(&Page::new(["a", "b"], [&a, &b], &comparison).unwrap());
    let html = written(&page);
    // No tag, comment or part of the page appears that a page with harmless names lacks.
    for mark in ["<script", "</script", "<!--", "id=\"facts\""] {
        let count = |html: &str| html.matches(mark).count();
        assert_eq!(count(&html), count(&harmless), "{mark}");
    }
    assert!(!html.contains("alert(1)<") && !html.contains('\u{202e}'));
    assert!(html.contains("&lt;/script&gt;&lt;script&gt;alert(1)"));
    assert_eq!(facts(&html)["why"], json!(hostile.replace('\u{202e}', r"\u{202e}")));
}

#[test]
fn the_page_asks_for_nothing() {
    let (a, b) = (ids(1, &[Some(0)]), ids(1, &[None]));
    let html = page_of(&a, &b);
    for address in ["http:", "https:", "src=\"/", "href=\"/", "@import", "url("] {
        assert!(!html.contains(address), "{address}");
    }
    let policy = "default-src 'none'; img-src data:;";
    assert!(html.contains(policy));
    assert_eq!(html.matches("src=\"").count(), 4);
    assert_eq!(html.matches("src=\"data:image/png;base64,iVBOR").count(), 4);
}

#[test]
fn the_summary_tells_what_was_compared() {
    let a = ids(1, &[Some(0), Some(1), None]);
    let b = Buffer::new([3, 1], 1, Content::Mask(vec![true, false, false].into()));
    let html = page_of(&a, &b);
    for text in [
        "<h1 class=\"bad\">differ: 1 pixel of 3, at (0, 1)</h1>",
        "3 × 1 pixels; compared: coverage; not compared: ids: only A tells",
        "<dt>only in A</dt><dd>1</dd>",
        "<span class=\"file\">a.npy</span>",
    ] {
        assert!(html.contains(text), "{text}");
    }
    let equal = page_of(&a, &a);
    assert!(equal.contains("<h1 class=\"good\">equal in everything compared</h1>"));
}

#[test]
fn beyond_a_size_values_are_left_out_and_the_page_says_so() {
    // 64 x 64 samples a pixel: 4,097 pixels have more than 4096 x 4096.
    let many = |pixels: u32| {
        let covered = vec![true; pixels as usize * 64 * 64];
        Buffer::new([pixels, 1], 64, Content::Mask(covered.into()))
    };
    let (a, b) = (many(4097), Buffer::new([4097, 1], 1, Content::Mask(vec![true; 4097].into())));
    let html = page_of(&a, &b);
    let facts = facts(&html);
    let said = "The values are left out: beyond 16,777,216 samples, a page has the pictures alone.";
    assert_eq!(facts["omitted"], json!(said));
    assert_eq!(facts["sides"][0]["arrays"], json!([]));
    assert!(!html.contains("id=\"a-covered\""));
}

#[test]
fn pictures_that_no_browser_draws_are_refused() {
    let wide = || Buffer::new([16_385, 1], 1, Content::Mask(vec![false; 16_385].into()));
    let (a, b) = (wide(), wide());
    let comparison = compare(&a, &b).unwrap();
    let refused = Page::new(["a", "b"], [&a, &b], &comparison).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "16385 x 1 pixels are too many for a page, which shows up to 67108864 pixels with sides up to 16384; \
         compare parts of the files"
    );
}
