//! Pictures and pages: every chart is well-formed and self-contained, and texts are escaped.

use std::fs;

use crate::program::{has, prints, run, stdout_of, table_1_with};
use roxmltree::Document;
use tipstrike::report::stations::GRAPHS;

const TABLE_1: &str = "cases/zhou-chen-2014.toml";
const FZG: &str = "cases/fzg-type-c.toml";

fn report(cases: &[&str], ending: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join(format!("report.{ending}"));
    let to = ["--out", out.to_str().unwrap()];
    assert_eq!(stdout_of(&[&["report"][..], cases, &to].concat()), "");
    fs::read_to_string(out).unwrap()
}

fn numbers_are_finite(text: &str) {
    let invalid = ["NaN", "inf,", ",inf", "\"inf"];
    assert!(invalid.iter().all(|word| !text.contains(word)), "{text}");
}

#[test]
fn every_chart_and_the_teeth_are_well_formed_pictures() {
    for name in GRAPHS.iter().map(|graph| graph.key).chain(["teeth"]) {
        for method in ["exact", "dynamic"] {
            let picture = stdout_of(&["plot", TABLE_1, "--chart", name, "--method", method]);
            numbers_are_finite(&picture);
            let xml = Document::parse(&picture).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(xml.root_element().has_tag_name(("http://www.w3.org/2000/svg", "svg")));
            assert!(picture.contains("prefers-color-scheme:dark"));
            let labels = xml.descendants().filter(|node| node.has_tag_name("text"));
            let labels = labels.count() + picture.matches("<text").count();
            assert!(labels > 3, "{name}");
        }
    }
}

#[test]
fn a_chart_has_axes_with_units_a_legend_below_the_field_and_its_marks() {
    let picture = stdout_of(&["plot", TABLE_1, "--chart", "gap"]);
    let field = 238.0;
    let xml = Document::parse(&picture).unwrap();
    let legend = xml.descendants().filter(|node| matches!(node.text(), Some("method exact" | "Δ")));
    for name in legend.filter(|node| node.has_attribute("y")) {
        assert!(name.attribute("y").unwrap().parse::<f64>().unwrap() > field);
    }
    let marks = ["Gap S, um", "driver roll angle after E, deg", ">Δ<", ">D<", ">E<"];
    has(&picture, &marks);
    // A closed form has no load share.
    prints(&[("plot TABLE_1 --chart load_share", &[">method static<"])]);
    // The speed of the case is below the first one of the curve, N = 0.1.
    let picture = stdout_of(&["plot", FZG, "--chart", "speed"]);
    has(&picture, &[">present<", ">N=1/3<", ">N=1/2<", ">N=1<", "rpm; N = mesh/natural frequency"]);
    let falling = picture.find("class=\"curve s1\"").expect("the speed falling");
    assert!(picture[..falling].contains("<g transform"), "points without contact below the curve");
}

/// The place of a value between the labels of an axis, in the direction of an attribute.
fn place_of(xml: &Document, anchor: &str, direction: &str, value: f64) -> f64 {
    let is_label = |node: &roxmltree::Node| node.attribute("text-anchor") == Some(anchor);
    let labels = xml.descendants().filter(is_label).filter_map(|node| {
        let label = node.text()?.parse::<f64>().ok()?;
        Some((label, node.attribute(direction)?.parse::<f64>().ok()?))
    });
    let labels: Vec<(f64, f64)> = labels.collect();
    let [first, .., last] = labels[..] else { panic!("two labels: {labels:?}") };
    first.1 + (value - first.0) / (last.0 - first.0) * (last.1 - first.1)
}

#[test]
fn a_curve_is_drawn_to_the_scale_of_its_axes() {
    let picture = stdout_of(&["plot", TABLE_1, "--chart", "force", "--method", "exact"]);
    let xml = Document::parse(&picture).unwrap();
    let is_curve = |node: &roxmltree::Node| node.attribute("class") == Some("curve s0");
    let mut curves = xml.descendants().filter(is_curve);
    let points = curves.find_map(|node| node.attribute("points")).unwrap();
    let points = points.split(' ').map(|point| point.split_once(',').unwrap());
    let points: Vec<[f64; 2]> = points.map(|(x, y)| [x, y].map(|at| at.parse().unwrap())).collect();
    // From 2191 N at D, 1.366 deg before E, to 0 N at E.
    for (angle, force, end) in [(-1.366, 2191.0, points[0]), (0.0, 0.0, points[points.len() - 1])] {
        let x = place_of(&xml, "middle", "x", angle);
        let y = place_of(&xml, "end", "y", force) - 5.0;
        assert!((end[0] - x).abs() < 1.0 && (end[1] - y).abs() < 1.0, "{end:?}, {x} {y}");
    }
    let [first, last] = [points[0], points[points.len() - 1]];
    assert!(first[0] < last[0] && first[1] < last[1], "to the right and upwards");
}

#[test]
fn notes_of_several_lines_are_one_sentence_and_stay_whole_in_the_case_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("noted.toml");
    let text = fs::read_to_string(TABLE_1).unwrap();
    let notes = "notes = \"\"\"one\n# two\n\nthree\"\"\"\n";
    let line = text.lines().find(|line| line.starts_with("notes = ")).unwrap();
    fs::write(&path, text.replace(&format!("{line}\n"), notes)).unwrap();
    let noted = path.to_str().unwrap();
    let page = report(&[noted], "html");
    assert!(page.contains("one # two three</span>"), "{page}");
    assert!(page.contains("&#34;&#34;&#34;one\n# two\n\nthree&#34;&#34;&#34;"), "{page}");
    assert!(stdout_of(&["solve", noted]).contains("Notes of the case: one # two three"));
}

#[test]
fn a_chart_without_a_curve_is_refused_and_a_picture_replaces_an_older_one() {
    let (code, _, words) =
        run(&["plot", "cases/tip-relief-enough.toml", "--chart", "impact_energy"]);
    assert_eq!(code, 3, "{words}");
    has(&words, &["the chart impact_energy has no curve"]);
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("force.svg");
    fs::write(&out, "old").unwrap();
    stdout_of(&["plot", TABLE_1, "--out", out.to_str().unwrap()]);
    assert!(fs::read_to_string(&out).unwrap().starts_with("<svg"));
    let png = out.with_extension("png");
    let (code, _, words) = run(&["plot", TABLE_1, "--out", png.to_str().unwrap()]);
    has(&words, &["use the extension .svg"]);
    assert_eq!((code, png.exists()), (2, false));
}

#[test]
fn the_contact_pattern_is_a_picture_of_a_pair_with_slices() {
    let helical = "cases/helical-20-35.toml";
    let picture = stdout_of(&["plot", helical, "--chart", "contact_pattern"]);
    numbers_are_finite(&picture);
    assert!(Document::parse(&picture).is_ok());
    has(&picture, &[">E<", ">B<", ">contact lines<", ">outside E to B<", "0 N/mm to ", "z, mm"]);
    let shades = (0..8).filter(|shade| picture.contains(&format!("class=\"m{shade}\"/>\n")));
    assert_eq!(shades.count(), 8, "every shade from the least to the greatest line load");
    assert!(report(&[helical], "html").contains("Contact pattern"));
    assert!(!report(&[TABLE_1], "html").contains("Contact pattern"));
    let (code, _, words) = run(&["plot", TABLE_1, "--chart", "contact_pattern"]);
    assert!(code == 3 && words.contains("a spur pair without misalignment"), "{words}");
}

#[test]
fn a_page_needs_no_other_file_and_has_every_part() {
    let page = report(&[TABLE_1], "html");
    numbers_are_finite(&page);
    let elsewhere = ["<script", "<link", "src=", "url(", "@import"];
    assert!(elsewhere.iter().all(|word| !page.contains(word)));
    let addresses = page.matches("http").count();
    assert_eq!(addresses, page.matches("http://www.w3.org/2000/svg").count());
    has(
        &page,
        &[
            "Force F<tspan dy=\"4\" font-size=\"11\">S</tspan><tspan dy=\"-4\">, N</tspan>",
            "Teeth at the first contact D",
            "<h1>Zhou &#38; Chen 2014, Table 1</h1>",
            "free impact 2191.0 N",
            concat!("tipstrike ", env!("CARGO_PKG_VERSION")),
            "<td class=\"label\">power</td><td class=\"symbol\">P</td><td class=\"number\">15 kW</td>",
            "<td class=\"label\">tip diameter</td><td class=\"symbol\">da<sub>1</sub> / da<sub>2</sub></td><td class=\"number soft\">110 mm</td>",
            "<td class=\"number\">2122.5</td><td class=\"unit\">N</td>",
            "impact force F<sub>S</sub> 2191.0 N &lt;= 2500 N",
            "Chin. J. Mech. Eng.",
            "base_pitch = &#34;16 um&#34;",
            "data:text/plain;charset=utf-8,",
            // The default defines the pair.
            ">pressure angle</td>",
        ],
    );
    assert!(!page.contains("tipstrike explain") && page.contains("deflection of 24.70 um"));
}

#[test]
fn several_cases_are_side_by_side_in_every_format() {
    let page = report(&[TABLE_1, FZG], "html");
    let force = "<td class=\"number\">2191.0</td><td class=\"number\">3718.8</td>";
    has(&page, &["<h1>2 gear pairs side by side</h1>", force]);
    let markdown = report(&[TABLE_1, FZG], "md");
    let row = "| impact force | F_S | 2191.0 | 3718.8 | N | Eq. 57 |";
    has(&markdown, &[row, "|---|---|--:|--:|---|---|"]);
    let csv = report(&[TABLE_1, FZG], "csv");
    assert_eq!(csv.lines().count(), 3);
    let json = report(&[TABLE_1, FZG], "json");
    assert_eq!(json, stdout_of(&["solve", TABLE_1, FZG, "--format", "json"]));
}

#[test]
fn a_case_with_variants_and_spread_has_a_table_of_each_on_its_pages() {
    let (_folder, case) = table_1_with(
        "\n[spread]\n\"deviations.base_pitch\" = { normal = \"2 um\" }\n\
        \"driven.tip_relief\" = { uniform = \"5 um\" }\n\
        [variants.relieved]\n\"driven.tip_relief\" = \"10 um\"\n\
        [variants.jammed]\n\"pair.centre_distance\" = \"90 mm\"\n",
    );
    let case = case.as_str();
    for ending in ["html", "md"] {
        let page = report(&[case, "--samples=500", "--set=driven.tip_relief=1 thou"], ending);
        let variants = ["Variants, with the differences from the case", "relieved: Corner contact"];
        let spread = ["Tolerance, 500 samples", "base pitch deviation 16 um", "25.4 um ±5 um"];
        let rest =
            ["Probability of corner contact", "impact_force", "P95", "refused", "jammed: Refused"];
        has(&page, &[&variants[..], &spread, &rest].concat());
        numbers_are_finite(&page);
    }
    assert!(!report(&[TABLE_1], "html").contains("<h2>Studies"));
    let several = report(&[case, FZG], "html");
    assert_eq!(several.matches("Variants, with").count(), 1);
}

#[test]
fn a_page_has_the_texts_about_the_case_and_leaves_out_its_appendix_on_request() {
    let about = "\n[about]\nproject = \"Mill um <7>\"\ndate = 2026-11-26\n\"drawing no.\" = 4711\n";
    let (_folder, case) = table_1_with(about);
    let case = case.as_str();
    let line =
        "Project: Mill um &#60;7&#62;</span> · <span>Date: 2026-11-26</span> · <span>Drawing";
    let page = report(&[case], "html");
    assert!(page.contains(line) && page.contains("<h2 class=\"appendix\">All results"), "{page}");
    let short = report(&[case, "--title", "Gear 7", "--no-appendix", "--paper", "a4"], "html");
    has(&short, &["<h1>Gear 7</h1>", "@page{size:A4;margin"]);
    assert_eq!(short.matches("<svg").count() + short.matches("</svg").count(), 10);
    fs::write(case, format!("format = 1\n{about}author = true\n")).unwrap();
    has(&run(&["solve", case]).2, &["about.author: expected a text in quotes"]);
}

#[test]
fn a_sweep_is_drawn_at_once_or_from_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let sweep = |out: &str| {
        let vary = ["--vary", "operation.speed=500..1500 rpm", "--points", "3"];
        run(&[&["sweep", TABLE_1][..], &vary, &["--only", "F_S", "--out", out]].concat())
    };
    let (picture, csv) = (file("sweep.svg"), file("sweep.csv"));
    assert_eq!((sweep(&picture).0, sweep(&csv).0), (0, 0));
    let drawn = fs::read_to_string(&picture).unwrap();
    assert!(Document::parse(&drawn).is_ok() && drawn.contains(">speed, rpm<"), "{drawn}");
    let pair = "Zhou &amp; Chen 2014, Table 1 · zhou-chen-2014.toml";
    assert_eq!(stdout_of(&["plot", "--sweep", &csv]), drawn.replace(pair, "sweep.csv"));
    assert_eq!(run(&["plot", "--sweep", TABLE_1]).0, 3);
}

#[test]
fn the_extension_selects_the_format_unless_the_command_or_the_option_has_another_one() {
    let folder = tempfile::tempdir().unwrap();
    let vary = ["--vary", "operation.speed=500,900 rpm"];
    let sweep = [&["sweep", TABLE_1][..], &vary].concat();
    let until = ["seek", TABLE_1, "--until", "F_S<=1 kN", "--vary", "operation.speed=1..9 rpm"];
    let ran = |command: &[&str], name: &str, format: &[&str]| {
        let out = folder.path().join(name);
        let (code, ..) = run(&[command, &["--out", out.to_str().unwrap()], format].concat());
        (code, fs::read_to_string(out).unwrap_or_default())
    };
    for (command, name, format) in [
        (&sweep[..], "a.pdf", &[][..]),
        (&sweep, "a.txt", &[]),
        (&sweep, "a.svg", &["--format", "csv"]),
        (&sweep, "a.csv", &["--format", "json"]),
        (&until, "a.csv", &[]),
        (&["relief", TABLE_1], "a.pdf", &[]),
        (&["excitation", TABLE_1], "a.svg", &[]),
        (&["tolerance", TABLE_1], "a.svg", &[]),
        (&["plot", TABLE_1], "a.png", &[]),
        (&["report", TABLE_1], "a.pdf", &[]),
        (&["report", TABLE_1], "a.txt", &[]),
    ] {
        assert_eq!(ran(command, name, format), (2, String::new()), "{command:?} {name} {format:?}");
    }
    for (command, name, format, start) in [
        (&sweep[..], "a.json", &[][..], "{"),
        (&sweep, "a.svg", &[], "<svg"),
        (&sweep, "a", &["--format", "json"], "{"),
        (&["excitation", TABLE_1], "b.csv", &[], "part,"),
        (&["report", TABLE_1], "b.md", &[], "# Zhou"),
    ] {
        let (code, text) = ran(command, name, format);
        assert!(code == 0 && text.starts_with(start), "{command:?} {name} {text}");
    }
    assert!(stdout_of(&["report", TABLE_1, "--out", "-", "--format", "md"]).starts_with("# Zhou"));
    assert!(stdout_of(&["report", TABLE_1, "--out", "-"]).starts_with("<!"));
}

#[test]
fn texts_of_a_case_are_harmless_in_a_page_and_in_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("odd.toml");
    let title = "</title><script>a|b`\u{1b}[2J";
    let text = fs::read_to_string(TABLE_1).unwrap();
    let text = text.replace("Zhou & Chen 2014, Table 1", &title.replace('\u{1b}', "\\u001b"));
    fs::write(&path, text).unwrap();
    let odd = path.to_str().unwrap();
    let page = report(&[odd, TABLE_1], "html");
    assert!(!page.contains("<script") && !page.contains('\u{1b}'));
    let markdown = report(&[odd], "md");
    assert!(!markdown.contains("<script>") || !markdown.contains("# </title>"), "{markdown}");
    assert!(markdown.contains("\\<script\\>a\\|b\\`"), "{markdown}");
}

#[test]
fn an_invalid_case_is_omitted() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    fs::write(path("bad.toml"), "format = 1\n").unwrap();
    let (code, ..) = run(&["report", &path("bad.toml"), TABLE_1, "--out", &path("a.md")]);
    assert_eq!(code, 3);
    assert!(fs::read_to_string(path("a.md")).unwrap().starts_with("# Zhou & Chen 2014, Table 1"));
}
