//! The library, scripts and blending, as users meet them.

use proptest::prelude::*;

use super::*;
use crate::{Control, Muscle, TICK_RATE};

fn library() -> &'static Library {
    Library::built_in().unwrap()
}

/// LEE 9 says which muscles make these three.
#[test]
fn happiness_surprise_and_worry_are_made_of_the_muscles_that_lee_names() {
    use Control::*;
    for (name, muscles) in [
        (
            "happiness",
            &[
                ZygomaticusMajor,
                ZygomaticusMinor,
                DepressorLabiiInferioris,
                Mentalis,
            ][..],
        ),
        ("surprise", &[FrontalisInner, FrontalisOuter, Jaw]),
        (
            "worry",
            &[
                CorrugatorSupercilii,
                FrontalisInner,
                DepressorAnguliOris,
                DepressorLabiiInferioris,
            ],
        ),
    ] {
        let expression = library().get(name).unwrap();
        for &control in muscles {
            assert!(expression.controls()[control] > 0.05, "{name}");
        }
    }
}

#[test]
fn the_library_is_large_enough_and_no_two_faces_are_alike() {
    let names: Vec<&str> = library().names().collect();
    assert!(names.len() >= 14, "{names:?}");
    for (i, a) in names.iter().enumerate() {
        let face = library().get(a).unwrap();
        assert!(face.about.ends_with('.'), "{a} does not say what it is");
        for b in &names[..i] {
            let other = library().get(b).unwrap().controls();
            let apart: f32 = (0..Control::COUNT)
                .map(|i| (face.controls().0[i] - other.0[i]).abs())
                .fold(0.0, f32::max);
            assert!(apart > 0.1, "{a} and {b} are the same face");
        }
    }
}

#[test]
fn winks_mirror_each_other() {
    let (left, right) = (
        library().get("wink_left").unwrap().controls(),
        library().get("wink_right").unwrap().controls(),
    );
    assert_eq!(left[Control::LidL], right[Control::LidR]);
    for muscle in Muscle::ALL {
        let mirrored = left.contraction(muscle, true) - right.contraction(muscle, false);
        assert!(mirrored.abs() < 1e-6, "{muscle:?}");
    }
    assert!(left.contraction(Muscle::ZygomaticusMajor, true) > 0.4);
}

#[test]
fn an_unknown_expression_lists_those_there_are() {
    let error = library().get("hapiness").unwrap_err().to_string();
    assert!(
        error.contains("`happiness`") && error.contains("wink_right"),
        "{error}"
    );
}

fn muscles(text: &str) -> Result<Controls, String> {
    let text = format!("{{\"keys\": [{{\"time_s\": 0, \"muscles\":\n {text}}}]}}");
    let script = Script::parse("x.json", &text).map_err(|error| error.to_string())?;
    Ok(script.controls_at(0))
}

#[test]
fn bellies_are_set_alone_or_beside_the_pair() {
    let sides = |text| {
        let controls = muscles(text).unwrap();
        [true, false].map(|left| controls.contraction(Muscle::Risorius, left))
    };
    assert_eq!(sides(r#"{"risorius": 0.5}"#), [0.5, 0.5]);
    assert_eq!(sides(r#"{"risorius_l": 0.5}"#), [0.5, 0.0]);
    assert_eq!(
        sides(r#"{"risorius_r": 0.75, "risorius": 0.25}"#),
        [0.25, 0.75]
    );
    assert_eq!(
        sides(r#"{"risorius_l": 0.75, "risorius_r": 0.25}"#),
        [0.75, 0.25]
    );
    assert_eq!(
        sides(r#"{"risorius": 0.5, "risorius_side": 0.25}"#),
        [0.75, 0.25]
    );
    assert_eq!(
        muscles(r#"{"risorius_l": 0.5}"#).unwrap()[Control::RisoriusSide],
        0.25
    );
}

#[test]
fn what_is_wrong_is_refused_with_its_line_and_its_mend() {
    for (bad, says) in [
        (
            r#"{"zygomaticus_mayor": 0.5}"#,
            "line 2: there is no control `zygomaticus_mayor`; the nearest is `zygomaticus_major`",
        ),
        (r#"{"risorius_left": 0.5}"#, "the nearest is `risorius_l`"),
        (r#"{"orbicularis_oris_superior_l": 0.5}"#, "line 2"),
        (
            r#"{"risorius": 1.5}"#,
            "line 2: `risorius` goes from 0 to 1, not to 1.5",
        ),
        (r#"{"risorius_r": -0.1}"#, "goes from 0 to 1"),
        (r#"{"risorius": 1e99}"#, "line 2"),
        (r#"{"risorius": "x"}"#, "line 2"),
        (
            r#"{"risorius": 0.1, "risorius": 0.2}"#,
            "`risorius` is there twice",
        ),
        (r#"[1, 2]"#, "zygomaticus_major"),
    ] {
        let error = muscles(bad).unwrap_err();
        assert!(
            error.contains("x.json, line 2") && error.contains(says),
            "{bad}: {error}"
        );
    }
    for (bad, says) in [
        ("{\"keys\": [\n]}", "line 2: a script without keys"),
        ("{}", "keys"),
        ("{\"keys\": [{\"time_s\": 0}]}", "either"),
        (
            "{\"keys\": [\n{\"time_s\": 0, \"expression\": \"smyle\"}]}",
            "line 2: there is no expression `smyle`; the nearest is `smile`",
        ),
        (
            "{\"keys\": [{\"time_s\": 0, \"expression\": \"smile\", \"muscles\": {}}]}",
            "either",
        ),
        (
            "{\"keys\": [{\"time_s\": -1, \"expression\": \"smile\"}]}",
            "goes from 0",
        ),
        (
            "{\"keys\": [{\"time_s\": 0, \"expression\": \"smile\", \"weight\": 2}]}",
            "from 0 to 1",
        ),
        (
            "{\"keys\": [{\"time_s\": 1, \"expression\": \"smile\"},\n{\"time_s\": 1, \"expression\": \"anger\"}]}",
            "line 2: the key at 1 s does not come after",
        ),
        (
            "{\"keys\": [{\"time\": 1, \"expression\": \"smile\"}]}",
            "time",
        ),
    ] {
        let error = Script::parse("x.json", bad).unwrap_err().to_string();
        assert!(
            error.starts_with("x.json, line") && error.contains(says),
            "{bad}: {error}"
        );
    }
    assert!(
        Script::parse("x.toml", "")
            .unwrap_err()
            .to_string()
            .contains(".ron")
    );
    assert!(Script::read(Path::new("no/such.ron")).is_err());
}

const RON: &str = r#"
// A greeting.
(keys: [
    (time_s: 0.0, expression: "neutral"),
    (time_s: 0.5, expression: "smile", weight: 0.5),
    (time_s: 2.0, muscles: {"frontalis_outer_l": 0.5, "jaw_rad": 0.1}),
])
"#;

#[test]
fn ron_says_the_same_as_json() {
    let json = r#"{"keys": [
        {"time_s": 0, "expression": "neutral"},
        {"time_s": 0.5, "expression": "smile", "weight": 0.5},
        {"time_s": 2, "muscles": {"frontalis_outer_l": 0.5, "jaw_rad": 0.1}}
    ]}"#;
    let (ron, json) = (
        Script::parse("a.ron", RON).unwrap(),
        Script::parse("a.json", json).unwrap(),
    );
    assert_eq!(ron, json);
    assert_eq!(ron.end(), 2 * TICK_RATE);
    let wrong = RON.replace("jaw_rad", "jaw");
    let error = Script::parse("a.ron", &wrong).unwrap_err().to_string();
    assert!(
        error.starts_with("a.ron, line 6: there is no control `jaw`; the nearest is `jaw_rad`"),
        "{error}"
    );
    let error = Script::parse("a.ron", "(keys: [\n(time_s: 0.0,").unwrap_err();
    assert!(error.to_string().starts_with("a.ron, line 2:"), "{error}");
}

#[test]
fn a_script_reaches_its_keys_holds_before_and_after_and_never_jerks() {
    let script = Script::parse(
        "x.json",
        r#"{"keys": [
            {"time_s": 1, "muscles": {"jaw_rad": 0.1}},
            {"time_s": 2, "muscles": {"jaw_rad": 0.2, "risorius_l": 1}},
            {"time_s": 2.5, "muscles": {"jaw_rad": 0.4}},
            {"time_s": 4, "muscles": {"jaw_rad": 0.1, "risorius_r": 1}}
        ]}"#,
    )
    .unwrap();
    let jaw = |ms: i64| script.controls_at(ms * TICK_RATE / 1000)[Control::Jaw];
    assert_eq!(
        [
            jaw(-5000),
            jaw(1000),
            jaw(2000),
            jaw(2500),
            jaw(4000),
            jaw(99_000)
        ],
        [0.1, 0.1, 0.2, 0.4, 0.1, 0.1]
    );
    // Through the second key it goes on rising, at the third, a peak, it turns gently.
    assert!((jaw(2010) - jaw(1990)) / 0.02 > 0.1);
    assert!((jaw(2510) - jaw(2490)).abs() < 1e-3);
    let mut before = script.controls_at(0);
    let mut speed = [0.0_f32; Control::COUNT];
    for ms in 1..5000 {
        let now = script.controls_at(ms * TICK_RATE / 1000);
        for &control in Control::ALL {
            let (least, most) = control.range();
            assert!((least..=most).contains(&now[control]), "{}", control.name());
            let went = (now[control] - before[control]) * 1000.0;
            let change = (went - speed[control as usize]).abs();
            // A corner would show as a jump by the speed itself, 1 and more.
            assert!(
                change < 0.15,
                "{} jerks by {change}/s at {ms} ms",
                control.name()
            );
            speed[control as usize] = went;
        }
        before = now;
    }
}

#[test]
fn speech_keeps_its_lips_and_the_brows_keep_the_expression() {
    let face = library().get("happiness").unwrap().controls();
    let mut speech = Controls::default();
    speech[Control::OrbicularisOrisSuperior] = 0.5;
    speech[Control::Jaw] = 0.1;
    let meeting = Mouth {
        speaking: 1.0,
        closing: 1.0,
    };
    let mut both = speech;
    both.express(face, 1.0, meeting);
    for control in [
        Control::OrbicularisOrisSuperior,
        Control::DepressorLabiiInferioris,
        Control::ZygomaticusMinor,
        Control::Jaw,
    ] {
        assert_eq!(both[control], speech[control], "{}", control.name());
    }
    let eyes = Control::OrbicularisOculiOrbital;
    assert!((both[eyes] - face[eyes]).abs() < 1e-6);
    assert!(
        both[Control::ZygomaticusMajor] > 0.2,
        "the corners smile on"
    );
    let mut silent = Controls::default();
    silent.express(face, 1.0, Mouth::default());
    for &control in Control::ALL {
        assert!(
            (silent[control] - face[control]).abs() < 1e-6,
            "{}",
            control.name()
        );
    }
    let mut nothing = speech;
    nothing.express(face, 0.0, meeting);
    assert_eq!(nothing, speech);
}

#[test]
fn wide_eyes_still_close() {
    let fear = library().get("fear").unwrap().controls();
    assert!(fear[Control::LidL] < -0.1);
    let mut blinking = Controls::default();
    blinking[Control::LidL] = 1.0;
    blinking.express(fear, 1.0, Mouth::default());
    assert_eq!(blinking[Control::LidL], 1.0);
    assert!(blinking[Control::LidR] < -0.1);
}

fn any_controls() -> impl Strategy<Value = Controls> {
    prop::collection::vec(-1.0_f32..=1.0, Control::COUNT).prop_map(|values| {
        let mut controls = Controls::default();
        controls.0.copy_from_slice(&values);
        controls.clamped()
    })
}

proptest! {
    #[test]
    fn nothing_laid_over_speech_leaves_its_range(
        mut speech in any_controls(), face in any_controls(), weight in prop::num::f32::ANY,
        speaking in -1.0_f32..2.0, closing in -1.0_f32..2.0,
    ) {
        speech.express(&face, weight, Mouth { speaking, closing });
        for &control in Control::ALL {
            let (least, most) = control.range();
            let value = speech[control];
            prop_assert!((least - 1e-6..=most + 1e-6).contains(&value), "{} {value}", control.name());
        }
    }

    #[test]
    fn any_text_is_read_or_refused_in_words(text in "\\PC*", json in any::<bool>()) {
        let name = if json { "x.json" } else { "x.ron" };
        if let Err(error) = Script::parse(name, &text) {
            prop_assert!(error.to_string().starts_with("x."));
        }
        let _ = Library::parse(name, &text);
    }

    #[test]
    fn changes_to_a_real_script_are_read_or_refused(at in 0..RON.len(), with in "\\PC{0,3}", ticks in any::<i64>()) {
        let mut text = RON.to_owned();
        text.replace_range(at..=at, &with);
        if let Ok(script) = Script::parse("x.ron", &text) {
            prop_assert!(script.controls_at(ticks).0.iter().all(|v| v.is_finite()));
        }
    }
}
