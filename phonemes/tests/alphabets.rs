//! Guards what the symbols of each alphabet become: every phone by each of its names, real symbol
//! lists, stress and diacritics; and that no text at all makes it fail.

mod material;

use mouthpiece_phonemes::{Alphabet, Notes, Phone, PhoneList, Segment, Stress, alphabet};
use proptest::prelude::*;

/// How each phone is written: TIMIT, CMU dictionary, X-SAMPA, espeak-ng, flite. `-`: has no symbol
/// of its own, or shares another phone's. IPA is [`Phone::ipa`]. Sources: TIMIT's `phoncode.doc`,
/// the CMU dictionary's phones, Wells's X-SAMPA, espeak-ng 1.51's en-us voice, flite 2.2's.
const NAMES: &str = "
    iy IY i i: iy;  ih IH I I ih;  eh EH E E eh;  ey EY eI eI ey;  ae AE { a ae;  aa AA A 0 aa;
    aa AA A A: aa;  aw AW aU aU aw;  ay AY aI aI ay;  ah AH1 V V ah;  ah AH2 V V ah;  ao AO O O: ao;
    oy OY OI OI oy;  ow OW oU oU ow;  uh UH U U uh;  uw UW u u: uw;  ux - } - -;  er ER1 3` 3: er;
    er ER2 3` 3: er;  ax AH0 @ @ ax;  ax AH0 @ a# ax;  ax AH0 @ @2 ax;  ix IH0 1 I# -;
    axr ER0 @` 3 -;  ax-h - @_0 - -;  l L l l l;  r R r\\ r r;  w W w w w;  y Y j j y;  hh HH h h hh;
    hv - h\\ - hv;  el - l= @L el;  m M m m m;  n N n n n;  ng NG N N ng;  em - m= @m em;
    en - n= n- en;  eng - N= - -;  nx - 4~ - nx;  s S s s s;  sh SH S S sh;  z Z z z z;  zh ZH Z Z zh;
    f F f f f;  th TH T T th;  v V v v v;  dh DH D D dh;  jh JH dZ dZ jh;  ch CH tS tS ch;
    b B b b b;  d D d d d;  g G g g g;  p P p p p;  t T t t t;  k K k k k;  dx - 4 t# dx;
    q - ? ? -;  bcl - b_} - -;  dcl - d_} - -;  gcl - g_} - -;  pcl - p_} - -;  tcl - t_} - -;
    kcl - k_} - -;  pau SIL ... _ pau;  pau SIL _ _: pau;  h# - - - h#;  epi - - - -";

fn codes(phones: PhoneList) -> String {
    let codes: Vec<&str> = phones.iter().map(|p| p.code()).collect();
    codes.join(" ")
}

/// The codes that a symbol becomes, after `~` where they are only the nearest.
fn read(alphabet: Alphabet, symbol: &str) -> String {
    let spoken = alphabet.spoken(symbol);
    let nearest = if spoken.exact { "" } else { "~" };
    nearest.to_owned() + &codes(spoken.phones)
}

#[test]
fn every_phone_is_found_by_each_of_its_names() {
    let alphabets = [
        Alphabet::Timit,
        Alphabet::Arpabet,
        Alphabet::XSampa,
        Alphabet::Espeak,
        Alphabet::Radio,
    ];
    let mut seen = std::collections::HashSet::new();
    for row in NAMES.split(';') {
        let names: Vec<&str> = row.split_whitespace().collect();
        let phone: Phone = names[0].parse().unwrap();
        seen.insert(phone);
        for (alphabet, name) in alphabets.iter().zip(&names) {
            if *name != "-" {
                assert_eq!(read(*alphabet, name), phone.code(), "{alphabet:?} {name}");
            }
        }
    }
    assert_eq!(seen.len(), Phone::ALL.len());
    for phone in Phone::ALL.into_iter().filter(|p| !p.is_silence()) {
        assert_eq!(read(Alphabet::Ipa, phone.ipa()), phone.code());
    }
}

#[test]
fn what_several_phones_write_is_read_as_several() {
    use Alphabet::{Arpabet, Espeak, Ipa, XSampa};
    for (alphabet, symbol, phones) in [
        (Ipa, "aɪɚ", "ay axr"),
        (Ipa, "ɑːɹ", "aa r"),
        (Ipa, "əl", "ax l"),
        (Ipa, "iə", "iy ax"),
        (Ipa, "juː", "y uw"),
        (Ipa, "ts", "t s"),
        (Espeak, "A@", "aa r"),
        (Espeak, "aI@", "ay ax"),
        (XSampa, "e@", "eh ax"),
        (XSampa, "@U", "ow"),
        (XSampa, "tS", "ch"),
        (Arpabet, "sil_B", "pau"),
        (Arpabet, "EH1_I", "eh"),
    ] {
        assert_eq!(read(alphabet, symbol), phones, "{alphabet:?} {symbol}");
    }
}

#[test]
fn diacritics_ties_and_forms_of_unicode_are_read() {
    for (symbol, phones) in [
        ("t͡ʃ", "ch"),
        ("d͜ʒ", "jh"),
        ("ʧ", "ch"),
        ("tʰ", "t"),
        ("tʲ", "t"),
        ("t̪", "t"),
        ("kʷ", "k"),
        ("ɜ˞", "er"),
        ("ə˞", "axr"),
        ("a͡ɪ", "ay"),
        ("aj", "ay"),
        ("əw", "ow"),
        ("ẽ", "eh"),
        ("e\u{303}", "eh"),
        ("ɔ̃", "ao"),
        ("ç", "hh"),
        ("c\u{327}", "hh"),
        ("g", "g"),
        ("ɫ̩", "el"),
        ("iː", "iy"),
        ("i:", "iy"),
        ("á", "ae"),
        ("ɑ˥˩", "aa"),
        ("ˈ", "epi"),
        ("ː", "epi"),
    ] {
        assert_eq!(read(Alphabet::Ipa, symbol), phones, "{symbol}");
    }
}

#[test]
fn stress_is_read_where_the_symbol_has_it() {
    let stress = |alphabet: Alphabet, symbol: &str| alphabet.spoken(symbol).stress;
    assert_eq!(stress(Alphabet::Arpabet, "AH0"), Some(Stress::Unstressed));
    assert_eq!(stress(Alphabet::Arpabet, "iy2"), Some(Stress::Secondary));
    assert_eq!(stress(Alphabet::Arpabet, "IY"), None);
    assert_eq!(stress(Alphabet::Ipa, "ˈaɪ"), Some(Stress::Primary));
    assert_eq!(stress(Alphabet::Ipa, "ˌʌ"), Some(Stress::Secondary));
    assert_eq!(stress(Alphabet::XSampa, "\"aI"), Some(Stress::Primary));
    assert_eq!(stress(Alphabet::Espeak, "'i:"), Some(Stress::Primary));
    assert_eq!(stress(Alphabet::Espeak, ",aI"), Some(Stress::Secondary));
    assert_eq!(stress(Alphabet::Espeak, "%I"), Some(Stress::Unstressed));
}

#[test]
fn foreign_and_unknown_symbols_go_to_the_nearest_and_say_so() {
    use Alphabet::{Arpabet, Espeak, Ipa, Timit, XSampa};
    for (alphabet, symbol, phones) in [
        // German: ich, ach, über, schön, Pferd, rot.
        (Ipa, "x", "~hh"),
        (Ipa, "yː", "~ux"),
        (Ipa, "øː", "~ow"),
        (Ipa, "ʁ", "~hv"),
        (Ipa, "p͡f", "p f"),
        // Vietnamese: ư, ơ, kh, đ, ng.
        (Ipa, "ɯ", "~ix"),
        (Ipa, "ɤ", "~ax"),
        (Ipa, "ɗ", "~d"),
        (Ipa, "ɓ", "~b"),
        (Ipa, "ŋ͡m", "ng m"),
        // A sound of the lips stays one.
        (Ipa, "ɸ", "~f"),
        (XSampa, "B", "~v"),
        (XSampa, "y", "~ux"),
        // Not of the alphabet at all.
        (Timit, "AH0", "~ax"),
        (Arpabet, "axr", "axr"),
        (Timit, "tsh", "~t sh"),
        (Timit, "ʃ", "~sh"),
        (Espeak, "I9", "~ih"),
        (Ipa, "字", "~ax"),
        (Ipa, "A", "~ae"),
        (Ipa, "☺", "~pau"),
        (Ipa, "12", "~pau"),
    ] {
        assert_eq!(read(alphabet, symbol), phones, "{alphabet:?} {symbol}");
    }
}

#[test]
fn silence_and_noise_are_pauses_everywhere() {
    for alphabet in Alphabet::ALL {
        for mark in [
            "", " ", "sil", "SIL", "sp", "spn", "pau", "_", "_:", "<eps>", "h#", "#",
        ] {
            let spoken = alphabet.spoken(mark);
            assert!(
                spoken.exact && spoken.phones[0].is_silence(),
                "{alphabet:?} {mark}"
            );
        }
    }
}

#[test]
fn an_alphabet_is_guessed_from_few_symbols() {
    for (expected, symbols) in [
        (
            Alphabet::Timit,
            "h# sh ix hv eh dcl d y axr dcl d aa kcl k h#",
        ),
        (Alphabet::Arpabet, "SIL SH IY1 HH AE1 D Y AO1 R SIL"),
        (Alphabet::Arpabet, "sil sh iy1 hh ae1 d y ao1 r sil"),
        (Alphabet::Arpabet, "B AA B"),
        (Alphabet::Radio, "pau sh iy hh ae d y ao r d aa r k pau"),
        (Alphabet::Ipa, "m ɑ n tʲ ɹ i ɒ ɫ f s t ə l aj ɚ"),
        (Alphabet::Ipa, "^ ð ə   b ɹ ˈ a ɪ t $"),
        (Alphabet::XSampa, "_ m A n t r\\ i { l _"),
        (Alphabet::XSampa, "_ D @ b r\\ aI t _"),
        (
            Alphabet::Espeak,
            "_: S i: h a d j U@ d A@ k s u: t# I2 n _:",
        ),
        (Alphabet::Espeak, "b a# t# 3 aI3 _:"),
    ] {
        assert_eq!(Alphabet::guess(symbols.split(' ')), expected, "{symbols}");
    }
    assert_eq!(Alphabet::guess([]), Alphabet::Timit);
}

#[test]
fn names_of_alphabets_read_back() {
    for alphabet in Alphabet::ALL {
        assert_eq!(alphabet.name().parse(), Ok(alphabet));
    }
    let error = "klingon".parse::<Alphabet>().unwrap_err().to_string();
    assert!(error.contains("`x-sampa`"), "{error}");
}

#[test]
fn symbols_that_other_programs_wrote_are_known_to_the_alphabet_guessed() {
    for (file, expected) in [
        ("generated_formats/s1.flite.psdur", Alphabet::Radio),
        ("generated_formats/s2.flite.psdur", Alphabet::Radio),
        ("generated_formats/s1.festival.lab", Alphabet::Radio),
        ("generated_formats/s1c.ev", Alphabet::Espeak),
        ("generated_formats/m.ev", Alphabet::Espeak),
        ("generated_formats/s2.piper.json", Alphabet::Ipa),
        ("hts_arctic/festival_mono/testutt_001.lab", Alphabet::Radio),
    ] {
        let Some(text) = material::text(file) else {
            return;
        };
        let symbols = material::symbols(file, &text);
        assert!(symbols.len() > 10, "{file}");
        let found = Alphabet::guess(symbols.iter().map(String::as_str));
        assert_eq!(found, expected, "{file}");
        for symbol in &symbols {
            let spoken = found.spoken(symbol);
            assert!(spoken.exact, "{file}: {symbol:?} {}", codes(spoken.phones));
        }
    }
}

proptest! {
    #[test]
    fn any_text_becomes_one_to_four_phones(symbol in "\\PC{0,12}|.{0,80}|[a-zA-Z0-9_:@#`\\\\~=^'\",%{}?&|!<>-]{1,5}") {
        for alphabet in Alphabet::ALL {
            let spoken = alphabet.spoken(&symbol);
            prop_assert!((1..=4).contains(&spoken.phones.len()));
            let lower = alphabet.spoken(&format!(" {symbol}\t"));
            prop_assert_eq!(spoken, lower);
        }
        Alphabet::guess([symbol.as_str()]);
    }

    #[test]
    fn the_phones_of_a_label_share_all_of_its_time(
        symbol in prop::sample::select(vec!["aɪɚ", "ɑːɹ", "b", "tʃ", "juː", "ŋ͡mts"]),
        start in 0_i64..1_000_000,
        ticks in 0_i64..5000,
    ) {
        let mut out: Vec<Segment> = Vec::new();
        alphabet::segments(Alphabet::Ipa, symbol, start, start + ticks, &mut out);
        let mut at = start;
        for segment in &out {
            prop_assert_eq!(segment.start, at);
            prop_assert!(segment.end > at);
            at = segment.end;
        }
        prop_assert_eq!(at, start + ticks);
    }
}

#[test]
fn what_aligners_and_voices_write_of_english_is_known() {
    // Montreal's English (US and UK), Piper's en_US and espeak-ng's English voices.
    let ipa = "a aj aw aː b bʲ c cʰ cʷ d dʒ dʲ d̪ e ej eː f fʲ h i iː j k kʰ kʷ l m mʲ m̩ n n̩ o ow p pʰ pʲ \
               pʷ s t tʃ tʰ tʲ tʷ t̪ u uː v vʲ w z æ ç ð ŋ ɐ ɑ ɑː ɒ ɒː ɔ ɔj ə əw ɚ ɛ ɛː ɜ ɜː ɝ ɟ ɟʷ ɡ ɡʷ ɪ ɫ \
               ɫ̩ ɱ ɲ ɹ ɾ ɾʲ ɾ̃ ʃ ʉ ʉː ʊ ʎ ʒ ʔ θ spn sil ᵻ əl ɑːɹ ɔːɹ oːɹ ɪɹ ɛɹ ʊɹ aɪɚ aɪə iə eɪ oʊ aɪ aʊ ɔɪ \
               əʊ eə ʊə n̩ ʌʉ ʍ";
    let espeak = "s n I t k d r l z @ p m E N 3 I# a eI b f I2 i t# g aI S 0 oU V v u: i: @L dZ h ; a# 3: tS \
                  j A@ aU w O: o@ aa O@ U T r- O2 e@ i@ i@3 OI U@ A: Z D aI3 @- aI@ n- t2 ? @2 aI2 VR IR w# _ _:";
    // MBROLA's us1 and en1.
    let sampa = "_ p b t d k g tS dZ f v T D s z S Z h m n N l r w j I E { A O U V @ r= i u EI AI OI @U AU 4 \
                 e Q i: u: 3: A: O: I@ e@ U@ eI aI aU";
    for (alphabet, symbols) in [
        (Alphabet::Ipa, ipa),
        (Alphabet::Espeak, espeak),
        (Alphabet::XSampa, sampa),
    ] {
        for symbol in symbols.split_whitespace() {
            let spoken = alphabet.spoken(symbol);
            assert!(
                spoken.exact,
                "{alphabet:?} {symbol}: {}",
                codes(spoken.phones)
            );
        }
        assert_eq!(Alphabet::guess(symbols.split_whitespace()), alphabet);
    }
}

/// `symbol` for ten ticks each.
fn stream(symbols: &[&'static str]) -> Vec<alphabet::Timed<'static>> {
    let timed = (0..).zip(symbols).map(|(at, symbol)| alphabet::Timed {
        symbol,
        start: 10 * at,
        end: 10 * at + 10,
    });
    timed.collect()
}

#[test]
fn a_stream_of_letters_becomes_phones_that_share_the_time_of_its_marks() {
    // "my church", as Piper writes it.
    let symbols = [
        "^", "m", "ˈ", "a", "ɪ", " ", "t", "ʃ", "ˈ", "ɜ", "ː", "t", "ʃ", ".", "$",
    ];
    let mut out = Vec::new();
    let mut notes = Notes::default();
    alphabet::join(Alphabet::Ipa, &stream(&symbols), &mut out, &mut notes);
    let heard: Vec<(&str, i64, i64)> = out
        .iter()
        .map(|s| (s.phone.code(), s.start, s.end))
        .collect();
    assert_eq!(
        heard,
        [
            ("h#", 0, 10),
            ("m", 10, 20),
            ("ay", 20, 55),
            ("ch", 55, 80),
            ("er", 80, 110),
            ("ch", 110, 130),
            ("pau", 130, 140),
            ("h#", 140, 150),
        ]
    );
    assert_eq!(out[2].stress, Some(Stress::Primary));
    assert_eq!(out[3].stress, None);
    assert_eq!(out[4].stress, Some(Stress::Primary));
    assert!(notes.finish().is_empty());
}

#[test]
fn a_voices_own_stream_keeps_its_length_and_order() {
    let Some(text) = material::text("generated_formats/s2.piper.json") else {
        return;
    };
    let rows: Vec<(f64, f64, String)> = serde_json::from_str(&text).unwrap();
    let ticks = |seconds: f64| (seconds * 48_000.0).round() as i64;
    let symbols: Vec<alphabet::Timed<'_>> = rows
        .iter()
        .map(|(start, end, symbol)| alphabet::Timed {
            symbol,
            start: ticks(*start),
            end: ticks(*end),
        })
        .collect();
    let mut out = Vec::new();
    let mut notes = Notes::default();
    alphabet::join(Alphabet::Ipa, &symbols, &mut out, &mut notes);
    assert!(out.windows(2).all(|pair| pair[0].end == pair[1].start));
    assert_eq!(out[0].start, symbols[0].start);
    assert_eq!(out[out.len() - 1].end, symbols[symbols.len() - 1].end);
    assert_eq!(notes.finish(), []);
    // "The bright blue moon may bob".
    let codes: Vec<&str> = out.iter().map(|s| s.phone.code()).take(15).collect();
    assert_eq!(codes.join(" "), "h# dh ax b r ay t b l uw m uw n m ey");
}
