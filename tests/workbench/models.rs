//! A model of another program opens as a case, and a save never overwrites the model.

use crate::harness::{Desk, SMALL};

use tipstrike::tui::testing::Effect;

const MODEL: &str = include_str!("../cli/rexs/two-stages-1.0.rexs");

#[test]
fn a_model_opens_as_a_case_that_is_saved_beside_it() {
    let mut desk = Desk::new(SMALL);
    let path = desk.write("gears.rexs", MODEL);
    let other = desk.write("other.rexs", &MODEL.replace("Stirnradstufe", "Another"));
    desk.perform(Effect::Load(path.clone()));
    desk.has(&["gears.toml", "3 mm"]);
    desk.perform(Effect::Load(other));
    desk.assert_shows("other.toml");
    desk.perform(Effect::Load(path));
    desk.fill("operation.speed", "1500 rpm").keys(&["Ctrl-S"]);
    desk.assert(desk.read("gears.toml").contains("speed = \"1500 rpm\""));
    assert_eq!(desk.read("gears.rexs"), MODEL);
}

/// A lock uses the full path of the folder, and the path of a model may lead through links.
#[test]
fn a_model_by_another_path_is_saved_by_the_session_that_opened_it() {
    let mut desk = Desk::new(SMALL);
    desk.write("gears.rexs", MODEL);
    std::fs::create_dir(desk.path("sub")).unwrap();
    desk.perform(Effect::Load(desk.path("sub/../gears.rexs")));
    desk.keys(&["Ctrl-S"]).assert_shows("saved");
    assert!(desk.read("gears.toml").contains("module = \"3 mm\""));
}

#[test]
fn a_model_without_a_spur_stage_is_refused_by_the_names_of_its_stages() {
    let mut desk = Desk::new(SMALL);
    let path = desk.write("m.rexs", &MODEL.replace("\"cylindrical_stage\"", "\"bevel_stage\""));
    desk.perform(Effect::Load(path));
    desk.assert_shows("m.rexs cannot be opened");
    desk.assert_shows("is a bevel stage");
}
