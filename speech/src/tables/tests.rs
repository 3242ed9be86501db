//! The built-in tables pass, and a broken one is refused by a sentence that names the row.

use mouthpiece_phonemes::Phone;

use super::{ARTICULATION, Contact, DOMINANCE, Tables};

/// The message for the built-in tables with one text replaced.
fn refusal(articulation: (&str, &str), dominance: (&str, &str)) -> String {
    let edit = |text: &str, (from, to): (&str, &str)| {
        assert!(text.contains(from), "{from} is not in the table");
        text.replacen(from, to, 1)
    };
    let a = edit(ARTICULATION.1, articulation);
    let d = edit(DOMINANCE.1, dominance);
    match Tables::parse(("a.toml", &a), ("d.toml", &d)) {
        Ok(_) => panic!("was accepted: {articulation:?} {dominance:?}"),
        Err(error) => error.to_string(),
    }
}

const SAME: (&str, &str) = ("\n", "\n");

#[test]
fn built_in_tables_pass_and_touch_where_they_must() {
    let tables = Tables::built_in().unwrap();
    for phone in Phone::ALL {
        let row = &tables.articulation[phone.index()];
        let touches = tables.dominance.class[&row.class].contact;
        // A release opens; its closure is the one that touches.
        let released = matches!(phone, Phone::P | Phone::B);
        let lips = phone.is_bilabial() && !released;
        assert_eq!(touches == Some(Contact::Lips), lips, "{phone}");
        assert_eq!(
            touches == Some(Contact::Teeth),
            phone.is_labiodental(),
            "{phone}"
        );
    }
}

#[test]
fn refusals_name_file_row_and_fault() {
    let cases = [
        (
            ("[iy]\n", "[xx]\n"),
            SAME,
            "a.toml: row `xx` is not one of TIMIT's 61 phones",
        ),
        (("[q]\n", "[\"q \"]\n"), SAME, "row `q `"),
        (
            ("aperture_mm = 5.0", "aperture_mm = 500.0"),
            SAME,
            "a.toml: row `iy`: aperture_mm is 500",
        ),
        (
            ("aperture_mm = 5.0", "aperture_mm = nan"),
            SAME,
            "row `iy`: aperture_mm is NaN",
        ),
        (
            ("jaw_rad = 0.030\n", "\n"),
            SAME,
            "row `iy` gives lips but no jaw_rad",
        ),
        (
            ("class = \"vowel\"", "class = \"vowels\""),
            SAME,
            "row `iy` names the class `vowels`",
        ),
        (
            ("aperture_mm = -2.0", "aperture_mm = 2.0"),
            SAME,
            "row `m` is of a class that makes contact with the other lip",
        ),
        (("width = 1.12", "widht = 1.12"), SAME, "a.toml, line "),
        (
            ("share = 0.45", "share = 1.5"),
            SAME,
            "row `ey.glide`: share is 1.5",
        ),
        (
            ("source = \"VTL: jaw i", "source = \"\" # "),
            SAME,
            "row `iy` has no source",
        ),
        (
            SAME,
            ("\"risorius\"", "\"risorious\""),
            "d.toml: [controls] lists `risorious`",
        ),
        (
            SAME,
            ("\"risorius\"", "\"jaw_rad\""),
            "lists `jaw_rad` twice",
        ),
        (
            SAME,
            ("alpha = 1.0", "alpha = -1.0"),
            "row `class.vowel.lips`: alpha is -1",
        ),
        (
            SAME,
            ("hold_share = 0.65", "hold_share = 2.0"),
            "row `contact`: hold_share is 2",
        ),
    ];
    for (articulation, dominance, part) in cases {
        let message = refusal(articulation, dominance);
        assert!(message.contains(part), "`{message}` lacks `{part}`");
    }
}

#[test]
fn a_missing_phone_is_named() {
    let rows = ARTICULATION.1.replacen("[zh]\nclass", "[unused]\nclass", 1);
    let message = Tables::parse(("a.toml", &rows), DOMINANCE)
        .unwrap_err()
        .to_string();
    assert!(message.contains("`unused`"), "{message}");
    let cut = ARTICULATION.1.split("[epi]").next().unwrap_or_default();
    let message = Tables::parse(("a.toml", cut), DOMINANCE)
        .unwrap_err()
        .to_string();
    assert!(message.contains("no row for the phone `epi`"), "{message}");
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let message = Tables::load(Some("nowhere/a.toml".as_ref()), None)
        .unwrap_err()
        .to_string();
    assert!(
        message.starts_with("cannot read nowhere/a.toml"),
        "{message}"
    );
}
