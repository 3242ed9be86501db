//! What each format's times mean, on small files written by hand.

use mouthpiece_phonemes::{Alphabet, LabelError, Labels, ReadOptions, Source, Stress, read};

use super::{notes, phones, sample, samples, words};

fn tier(name: &str, tier: &str) -> Result<Labels, LabelError> {
    let mut options = ReadOptions::default();
    options.tier = Some(tier.to_owned());
    mouthpiece_phonemes::read_file(&samples().join(name), None, &options)
}

#[test]
fn xlabel_gives_ends_after_a_header() {
    let labels = sample("xlabel/phones.lab");
    let wanted = "0 pau 200, 200 hh 260, 260 ax 320, 320 l 400, 400 ow 620, 620 pau 800";
    assert_eq!(phones(&labels), wanted);
    let labels = sample("xlabel/words.lab");
    assert_eq!(
        words(&labels),
        "0 Hello 620, 620 there 1050, 1050 everybody 1400"
    );
    assert!(labels.segments.len() > 8, "{labels:?}");
    assert!(notes(&labels).contains("pronunciation dictionary"));
}

#[test]
fn flite_starts_over_in_each_sentence() {
    let wanted = "0 pau 150, 150 hh 210, 210 ay 400, 400 pau 520, \
                  520 pau 660, 660 b 720, 720 ay 930, 930 pau 1120";
    assert_eq!(phones(&sample("flite/two_sentences.txt")), wanted);
    // Sentences in one line are parted by the times alone.
    let one_line = "pau:0.150 hh:0.210 ay:0.400 pau:0.520 pau:0.140 b:0.200 ay:0.410 pau:0.600";
    let source = Source {
        name: "x",
        bytes: one_line.as_bytes(),
    };
    let labels = read(&source, None, &ReadOptions::default()).unwrap();
    assert_eq!(phones(&labels), wanted);
}

#[test]
fn textgrids_of_each_encoding_and_form_are_read() {
    let long = sample("textgrid/long.TextGrid");
    assert_eq!(
        phones(&long),
        "0 pau 250, 250 ow 400, 400 b 500, 500 iy 750, 750 pau 1000"
    );
    assert_eq!(words(&long), "250 “ob\"i 750");
    for other in ["utf16le", "utf16be"] {
        assert_eq!(sample(&format!("textgrid/{other}.TextGrid")), long);
    }
    // Neither tier has a telling name; the second's content tells. The third interval lasts no
    // time, and the first is cut where the second starts.
    let short = sample("textgrid/short.TextGrid");
    assert_eq!(phones(&short), "0 aa 200, 200 hh 600");
    let said = notes(&short);
    assert!(
        said.contains("1 phone ended after the start of the next"),
        "{said}"
    );
    assert!(said.contains("1 phone lasted no time"), "{said}");
}

#[test]
fn a_tier_is_chosen_by_name_or_number() {
    let name = "textgrid/long.TextGrid";
    let by_name = tier(name, "WORDS").unwrap();
    assert_eq!(words(&by_name), "250 “ob\"i 750");
    assert!(!by_name.segments.is_empty());
    // Tiers of points are no tiers that could be read.
    assert_eq!(phones(&tier(name, "2").unwrap()), phones(&sample(name)));
    let said = tier(name, "notes").unwrap_err().to_string();
    assert!(
        said.ends_with("has no tier `notes` of intervals; name one of `words`, `phones`"),
        "{said}"
    );
    // Two of one name: the first, and the number of the other.
    let name = "textgrid/short.TextGrid";
    let first = tier(name, "Mary").unwrap();
    assert_eq!(words(&first), "0 oh 250, 250 my 500, 500 word 1000");
    assert!(notes(&first).contains("numbers 2"), "{}", notes(&first));
    assert_eq!(phones(&tier(name, "2").unwrap()), "0 aa 200, 200 hh 600");
}

#[test]
fn mbrola_gives_lengths() {
    let wanted = "0 pau 50, 50 hh 111, 111 ax 166, 166 l 228, 228 ow 438, 438 pau 538";
    assert_eq!(phones(&sample("mbrola/hello.pho")), wanted);
}

#[test]
fn hts_counts_100_ns_and_states_are_one_phone() {
    let wanted = "0 pau 200, 200 hh 260, 260 ay 460, 460 pau 600";
    for name in ["mono", "full", "states"] {
        let labels = sample(&format!("hts/{name}.lab"));
        assert_eq!(phones(&labels), wanted, "{name}");
        let stress = labels.segments[2].stress;
        let known = (name != "mono").then_some(Stress::Primary);
        assert_eq!(stress, known, "{name}");
    }
}

#[test]
fn json_of_aligners_is_read() {
    let gentle = sample("gentle/hello.json");
    assert_eq!(
        phones(&gentle),
        "200 hh 300, 300 ay 500, 600 hh 700, 700 ow 900"
    );
    assert_eq!(words(&gentle), "200 hi 500, 600 ho 900");
    assert_eq!(gentle.segments[1].stress, Some(Stress::Primary));
    assert!(notes(&gentle).contains("words not found in the sound (1)"));
    let wanted = "0 pau 300, 300 b 450, 450 oy 800, 800 pau 1000";
    let mfa = sample("mfa-json/aligned.json");
    assert_eq!(phones(&mfa), wanted);
    assert_eq!(words(&mfa), "300 boy 800");
    let praatio = sample("mfa-json/praatio.json");
    assert_eq!(phones(&praatio), "300 b 450, 450 oy 800");
}

#[test]
fn words_and_letters_become_phones() {
    let whisper = sample("whisper/x.json");
    // The number has no times: it gets those between its neighbours.
    assert_eq!(words(&whisper), "8 hello 410, 410 24 950, 950 world 1330");
    assert!(notes(&whisper).contains("words without times (1)"));
    let first = whisper.segments.first().unwrap();
    assert_eq!((first.phone.code(), super::ms(first.start)), ("hh", 8));
    assert_eq!(words(&sample("whisper/chars.json")), "0 oh 200, 250 hi 500");
    assert_eq!(
        words(&sample("whisper/words.json")),
        "100 oh 300, 280 my 700"
    );
    let voice = sample("characters/voice.json");
    assert_eq!(words(&voice), "0 I 200, 250 two! 700");
    assert_eq!(
        words(&sample("characters/bare.json")),
        "0 oh 200, 250 hi 500"
    );
    // The second piece's times start over.
    let stream = sample("characters/stream.ndjson");
    assert_eq!(words(&stream), "0 oh 200, 250 hi 500");
    for labels in [whisper, voice, stream] {
        assert!(labels.segments.len() >= 3, "{labels:?}");
        assert!(labels.segments.is_sorted_by(|a, b| a.end <= b.start));
    }
}

#[test]
fn visemes_become_phones_that_look_alike_with_a_note() {
    let azure = "50 pau 150, 150 m 200, 200 aa 350";
    assert_eq!(phones(&sample("azure/list.json")), azure);
    let lines = sample("azure/lines.json");
    assert_eq!(
        phones(&lines),
        "50 pau 150, 150 f 200, 200 pau 350, 350 eh 450"
    );
    assert!(
        notes(&lines).contains("`77` is none of Azure's"),
        "{}",
        notes(&lines)
    );
    assert_eq!(phones(&sample("azure/held.json")), "0 hh 90, 90 ay 290");
    let polly = sample("polly/marks.json");
    assert_eq!(phones(&polly), "6 m 90, 90 aa 250, 250 m 330, 330 ao 600");
    assert_eq!(words(&polly), "6 My 250, 250 boy 600");
    assert_eq!(words(&sample("polly/words.json")), "6 My 250, 250 boy 550");
    let json = sample("rhubarb/cues.json");
    assert_eq!(
        phones(&json),
        "0 pau 200, 200 m 300, 300 aa 600, 600 pau 900"
    );
    let tsv = sample("rhubarb/cues.tsv");
    assert_eq!(phones(&tsv), "0 pau 200, 200 m 300, 300 aa 600, 600 uw 900");
    for labels in [lines, polly, json, tsv] {
        assert!(notes(&labels).contains("the tongue is coarse"));
    }
}

#[test]
fn pipers_signs_join_to_phones() {
    let labels = sample("piper/boy.json");
    let wanted = "0 h# 50, 50 b 100, 100 oy 365, 365 t 450, 450 uw 600, 600 pau 800, 800 h# 850";
    assert_eq!(phones(&labels), wanted);
    assert_eq!(labels.segments[2].stress, Some(Stress::Primary));
}

#[test]
fn espeaks_silence_before_a_burst_is_the_stops_closure() {
    let labels = sample("espeak-events/copy.tsv");
    // Samples at 22050 Hz are finer than milliseconds; 44 ms before each burst, or as much as
    // there is.
    let wanted = "0 kcl 10, 10 k 60, 60 aa 156, 156 pcl 200, 200 p 240, 240 iy 400, 400 pau 600";
    assert_eq!(phones(&labels), wanted);
    assert_eq!(labels.segments.last().unwrap().end, 600 * 48);
}

#[test]
fn our_own_lines_are_read() {
    let labels = sample("ndjson/labels.ndjson");
    assert_eq!(phones(&labels), "0 h# 100, 100 ow 500, 500 h# 800");
    assert_eq!(words(&labels), "100 oh 500");
    assert_eq!(labels.segments[1].stress, Some(Stress::Primary));
    assert!(labels.notes.is_empty());
    assert_eq!(
        phones(&sample("ndjson/samples.ndjson")),
        "0 ch 100, 100 ow 500"
    );
    assert_eq!(phones(&sample("ndjson/wire.ndjson")), "0 h# 100, 100 b 200");
}

#[test]
fn the_user_may_say_which_alphabet() {
    let mut options = ReadOptions::default();
    options.alphabet = Some(Alphabet::XSampa);
    let source = Source {
        name: "x.lab",
        bytes: b"#\n0.1 100 D\n0.3 100 i:\n0.4 100 S\n",
    };
    let labels = read(&source, None, &options).unwrap();
    assert_eq!(phones(&labels), "0 dh 100, 100 iy 300, 300 sh 400");
}

#[test]
fn each_bad_file_is_answered_with_file_line_and_mend() {
    let cases: [(&str, &str, &str); 20] = [
        (
            "xlabel",
            "#\n0.1 100 aa\n0.x 100 b\n",
            "x, line 3: `0.x` is no time; write seconds, such as 1.25",
        ),
        (
            "xlabel",
            "#\n0.2 100 aa\n0.1 100 b\n",
            "line 3: ends at 0.100000 but starts at 0.200000",
        ),
        (
            "xlabel",
            "#\n0.2 aa\n",
            "line 2: `0.2 aa` stands where `end colour label` should",
        ),
        (
            "flite",
            "pau:0.1 aa\n",
            "line 1: `aa` stands where `phone:END` should",
        ),
        (
            "flite",
            "pau:99999999\n",
            "line 1: time 99999999 lies beyond 24 hours; check its unit",
        ),
        (
            "textgrid",
            "\"ooTextFile\"\n\"TextGrid\"\n0 1 <exists> 1\n\"Other\"\n",
            "line 4: `Other` stands where \"IntervalTier\" or \"TextTier\" should",
        ),
        (
            "textgrid",
            "\"ooTextFile\"\n\"TextGrid\"\n0 1 <exists> 1\n\"IntervalTier\" \"a\" 0 1 2\n0 1 \"a\"",
            "the file ends where the start of an interval should stand; save it again, whole",
        ),
        (
            "textgrid",
            "0 1 <exists> 1\n\"IntervalTier\" \"a\" 0 1 1\n0.5 0.4 \"a\"",
            "line 3: ends at 0.400000 but starts at 0.500000",
        ),
        (
            "textgrid",
            "0 1 <exists> 1\n\"IntervalTier\" \"a\" 0 1 1\n0.5 0.4 \"a",
            "line 3: the file ends where the closing quotation mark",
        ),
        (
            "mbrola",
            "_ 50\nh\n",
            "line 2: `h` stands where `symbol milliseconds` should",
        ),
        (
            "mbrola",
            "_ 50\nh -4\n",
            "line 2: ends at 0.046000 but starts at 0.050000",
        ),
        (
            "hts",
            "0 100 a\n100 200\n",
            "line 2: `100 200` stands where `start end name` should",
        ),
        (
            "gentle",
            "{\"words\": [\n{\"word\": 5}]}",
            "line 2: not the JSON of this format (invalid type: integer `5`",
        ),
        (
            "gentle",
            "{\"words\": [",
            "line 1: not the JSON of this format (EOF while parsing a list",
        ),
        (
            "mfa-json",
            "{\"tiers\": {\"a\": {\"entries\":\n[[1]]}}}",
            "line 2: not the JSON of this format (an entry without start, end and label",
        ),
        (
            "azure",
            "[{\"audioOffset\": \"soon\", \"visemeId\": 1}]",
            "line 1: `soon` is no time; write units of 100 ns",
        ),
        (
            "polly",
            "{\"time\":1,\"type\":\"word\"}\n{\"time\":1}\n",
            "line 2: not the JSON of this format (missing field `type`)",
        ),
        (
            "characters",
            "{\"characters\":[\"a\"],\"character_start_times_seconds\":[],\"character_end_times_seconds\":[]}",
            "lists of different length",
        ),
        (
            "piper",
            "[[0, 0.2, \"a\"],\n[0.1, 0.3, \"b\"]]",
            "line 2: ends at 0.100000 but starts at 0.200000",
        ),
        (
            "ndjson",
            "{\"start\":0,\"phone\":\"aa\"}",
            "line 1: not the JSON of this format (start or end is missing); write {\"start\":0",
        ),
    ];
    for (format, text, wanted) in cases {
        let source = Source {
            name: "x",
            bytes: text.as_bytes(),
        };
        let error = read(&source, Some(format), &ReadOptions::default()).unwrap_err();
        let said = error.to_string();
        assert!(said.contains(wanted), "{said:?} does not say {wanted:?}");
        assert!(said.starts_with("x, line ") && said.len() < 300, "{said:?}");
    }
}
