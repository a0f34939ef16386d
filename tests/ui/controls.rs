//! Buttons, keys and panels.

use eframe::egui::{Key, Modifiers, PointerButton, Shape, pos2, vec2};
use egui_kittest::kittest::Queryable;
use figurant::viewport::worker::Renderer;
use serde_json::json;

use super::common::{Folder, Window, config, open, rgb, session, settle, until};

/// Lines of boxes that are drawn over the picture.
fn boxes(window: &Window) -> usize {
    let shapes = window.output().shapes.iter();
    shapes.filter(|s| matches!(&s.shape, Shape::Rect(r) if r.stroke.width == 1.4)).count()
}

/// Dots of keypoints that are drawn over the picture, without the dark rings under hollow ones.
fn dots(window: &Window) -> usize {
    let shapes = window.output().shapes.iter();
    shapes.filter(|s| matches!(&s.shape, Shape::Circle(c) if c.stroke.width != 2.2)).count()
}

#[test]
fn buttons_and_keys_step_through_frames() {
    let folder = Folder::new();
    let mut window = open(folder.config());
    let first = settle(&mut window);
    assert_eq!(first.request.frame, 0);
    window.get_by_label("Next").click();
    let second = settle(&mut window);
    assert_eq!(second.request.frame, 1);
    assert_ne!(rgb(&first), rgb(&second));
    window.key_press(Key::Space);
    until(&mut window, "frame 2", |s| s.frame == 2);
    window.key_press_modifiers(Modifiers::SHIFT, Key::Space);
    until(&mut window, "frame 1", |s| s.frame == 1);
    window.get_by_label("Previous").click();
    let again = settle(&mut window);
    assert_eq!(again.request.frame, 0);
    assert_eq!(rgb(&first), rgb(&again));
}

#[test]
fn another_seed_is_another_picture() {
    let folder = Folder::new();
    let mut window = open(folder.config());
    let first = settle(&mut window);
    window.get_by_label("Seed").set_value_accesskit(f64::from(u32::MAX));
    until(&mut window, "the seed", |s| s.seed == u64::from(u32::MAX));
    let second = settle(&mut window);
    assert_eq!(second.request.seed, u64::from(u32::MAX));
    assert_ne!(rgb(&first), rgb(&second));
}

#[test]
fn overlays_are_drawn_while_they_are_on() {
    let folder = Folder::new();
    let mut window = open(folder.config());
    let shown = settle(&mut window);
    let people = shown.annotations.people.iter();
    let [with_box, points] = people.fold([0, 0], |[b, k], p| {
        let dots = p.keypoints.iter().flatten().filter(|k| k.coco_visibility() > 0).count();
        [b + usize::from(p.bbox.is_some()), k + dots]
    });
    assert!(with_box > 1 && points > 17, "{with_box} boxes, {points} keypoints");
    assert_eq!((boxes(&window), dots(&window)), (with_box, points));
    window.get_by_label("Boxes").click();
    settle(&mut window);
    assert_eq!((boxes(&window), dots(&window)), (0, points));
    window.key_press(Key::K);
    until(&mut window, "no keypoints", |s| s.overlays.is_empty());
    settle(&mut window);
    assert_eq!((boxes(&window), dots(&window)), (0, 0));
    window.key_press(Key::B);
    window.get_by_label("Masks").click();
    let shown = settle(&mut window);
    assert_eq!((boxes(&window), dots(&window)), (with_box, 0));
    assert!(
        shown.annotations.instance_ids.is_some() && shown.annotations.people[0].keypoints.is_none()
    );
}

#[test]
fn what_nobody_wants_is_skipped_and_the_panel_says_why() {
    let folder = Folder::new();
    let mut window = open(folder.config());
    settle(&mut window);
    assert!(window.query_by_label("keypoints").is_none());
    window.get_by_label("Keypoints").click();
    settle(&mut window);
    window.get_by_label("keypoints");
    window.get_by_label_contains("nothing shown needs it");
    window.get_by_label("shade");
}

#[test]
fn a_free_camera_sees_the_same_scene_from_elsewhere_and_goes_back() {
    let folder = Folder::new();
    let mut window = open(folder.config());
    let data = settle(&mut window);
    window.get_by_label("Free").click();
    let start = settle(&mut window);
    assert!(start.request.viewpoint.is_some());
    assert_eq!(rgb(&data), rgb(&start), "it starts where the data camera stands");
    let at = window.get_by_label("Picture").rect().center();
    window.hover_at(at);
    window.step();
    window.drag_at(at);
    window.step();
    window.hover_at(at + vec2(120.0, 10.0));
    window.step();
    window.drop_at(at + vec2(120.0, 10.0));
    let orbited = settle(&mut window);
    assert_ne!(rgb(&data), rgb(&orbited));
    assert_eq!(data.scene.people, orbited.scene.people);
    assert_ne!(data.annotations.camera, orbited.annotations.camera);
    window.key_down(Key::W);
    window.run_steps(4);
    window.key_up(Key::W);
    let flown = settle(&mut window);
    assert_ne!(flown.scene.camera.position_m, orbited.scene.camera.position_m);
    assert_eq!(flown.scene.camera.rotation, orbited.scene.camera.rotation);
    window.get_by_label("Data").click();
    let back = settle(&mut window);
    assert_eq!(back.request.viewpoint, None);
    assert_eq!(rgb(&data), rgb(&back));
}

#[test]
fn the_wheel_zooms_and_double_clicks_fit() {
    let folder = Folder::new();
    let mut window = open(folder.config());
    settle(&mut window);
    let pane = window.get_by_label("Picture").rect();
    let fit = session(&window).zoom;
    window.key_press(Key::Num1);
    window.run_steps(2);
    let actual = session(&window).zoom;
    assert_ne!(fit, actual);
    window.hover_at(pane.left_top() + vec2(50.0, 70.0));
    window.event(eframe::egui::Event::MouseWheel {
        unit: eframe::egui::MouseWheelUnit::Point,
        delta: vec2(0.0, 200.0),
        phase: eframe::egui::TouchPhase::Move,
        source: eframe::egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    window.run_steps(20);
    assert_ne!(session(&window).zoom, actual);
    window.key_press(Key::F);
    window.run_steps(2);
    assert_eq!(session(&window).zoom, fit);
}

#[test]
fn without_a_device_the_native_engine_stays() {
    let folder = Folder::new();
    let mut window = open(folder.config());
    settle(&mut window);
    window.key_press(Key::G);
    window.run_steps(2);
    assert_eq!(session(&window).renderer, Renderer::Native);
    window.get_by_label("Graphics").click_button(PointerButton::Primary);
    window.run_steps(2);
    assert_eq!(session(&window).renderer, Renderer::Native);
}

#[test]
fn a_broken_config_is_told_by_its_fields_and_the_last_good_one_stays() {
    let folder = Folder::new();
    let mut window = open(folder.config());
    let before = settle(&mut window);
    let mut broken = config();
    broken["people"]["plaecment"] = json!({});
    broken["image"]["width"] = json!(-3);
    folder.write(&broken);
    window.get_by_label("Reload").click();
    until(&mut window, "the problems", |s| !s.config_problems.is_empty());
    window.get_by_label("image.width");
    window.get_by_label("people.plaecment");
    window.get_by_label_contains("Problems (");
    assert_eq!(rgb(session(&window).shown.as_ref().unwrap()), rgb(&before));
    folder.write(&config());
    window.get_by_label("Reload").click();
    until(&mut window, "the good config", |s| s.config_problems.is_empty() && !s.busy);
    assert_eq!(rgb(&settle(&mut window)), rgb(&before));
}

#[test]
fn a_config_that_was_never_good_shows_its_problems() {
    let folder = Folder::new();
    std::fs::write(folder.config(), "{\"version\": 1, \"frams\": 3}").unwrap();
    let mut window = open(folder.config());
    until(&mut window, "the problems", |s| !s.config_problems.is_empty());
    window.get_by_label("frams");
    assert!(session(&window).shown.is_none());
    window.key_press(Key::Space);
    window.key_press(Key::C);
    window.hover_at(pos2(300.0, 300.0));
    window.run_steps(3);
}

#[test]
fn every_control_tells_what_it_does() {
    let folder = Folder::new();
    let mut window = open(folder.config());
    settle(&mut window);
    for (label, part) in [
        ("Next", "Shows the next frame. (Space)"),
        ("Boxes", "Draws the box"),
        ("Free", "Drag orbits"),
        ("Native", "same bytes on every machine"),
        ("1/2", "Renders 48 x 48 pixels"),
    ] {
        window.get_by_label(label).hover();
        window.run_steps(40);
        assert!(window.query_by_label_contains(part).is_some(), "{label} does not tell \"{part}\"");
    }
}
