//! Numbers as English words, American fashion ("one hundred five").

const ONES: [&str; 20] = [
    "zero",
    "one",
    "two",
    "three",
    "four",
    "five",
    "six",
    "seven",
    "eight",
    "nine",
    "ten",
    "eleven",
    "twelve",
    "thirteen",
    "fourteen",
    "fifteen",
    "sixteen",
    "seventeen",
    "eighteen",
    "nineteen",
];

const TENS: [&str; 10] = [
    "", "ten", "twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety",
];

/// Names of the groups of three digits. A number with more groups is said digit by digit.
const GROUPS: [&str; 5] = ["", "thousand", "million", "billion", "trillion"];

/// A whole number of digits, with or without commas: as a year where it may be one.
pub(super) fn number(text: &str) -> Vec<&'static str> {
    let bare: String = text.chars().filter(char::is_ascii_digit).collect();
    let grouped = text.contains(',');
    let Ok(value) = bare.parse::<u64>() else {
        return digits(&bare);
    };
    // A number with zeros before it is a name, as "007" is.
    let leading = bare.len() > 1 && bare.starts_with('0');
    if leading || bare.len() > 3 * GROUPS.len() {
        return digits(&bare);
    }
    if !grouped && bare.len() == 4 && is_year(value) {
        return year(value);
    }
    let mut words = Vec::new();
    cardinal(value, &mut words);
    words
}

/// Said in two halves: "nineteen ninety", but "two thousand five" and "two thousand".
fn is_year(value: u64) -> bool {
    (1100..2000).contains(&value) || (2010..2100).contains(&value)
}

fn year(value: u64) -> Vec<&'static str> {
    let mut words = Vec::new();
    cardinal(value / 100, &mut words);
    match value % 100 {
        0 => words.push("hundred"),
        rest @ 1..10 => {
            words.push("oh");
            cardinal(rest, &mut words);
        }
        rest => cardinal(rest, &mut words),
    }
    words
}

fn cardinal(value: u64, words: &mut Vec<&'static str>) {
    if value == 0 {
        words.push(ONES[0]);
        return;
    }
    for (power, name) in GROUPS.into_iter().enumerate().rev() {
        let group = value / 1000_u64.pow(power as u32) % 1000;
        if group == 0 {
            continue;
        }
        hundreds(group as usize, words);
        if !name.is_empty() {
            words.push(name);
        }
    }
}

/// A number below a thousand.
fn hundreds(value: usize, words: &mut Vec<&'static str>) {
    let (hundreds, rest) = (value / 100, value % 100);
    if let (1.., Some(name)) = (hundreds, ONES.get(hundreds)) {
        words.extend([*name, "hundred"]);
    }
    match (rest, ONES.get(rest)) {
        (0, _) => {}
        (_, Some(name)) => words.push(name),
        (_, None) => {
            words.extend(TENS.get(rest / 10));
            words.extend(ONES.get(rest % 10).filter(|_| rest % 10 > 0));
        }
    }
}

/// Each digit by itself.
pub(super) fn digits(text: &str) -> Vec<&'static str> {
    let values = text.bytes().filter(u8::is_ascii_digit);
    values
        .filter_map(|b| ONES.get(usize::from(b - b'0')).copied())
        .collect()
}

/// The number's place in a row: "twenty first".
pub(super) fn ordinal(text: &str) -> Vec<&'static str> {
    let grouped = format!("{text},");
    let mut words = number(&grouped);
    if let Some(last) = words.last_mut() {
        let row = ORDINALS.iter().find(|row| row.0 == *last);
        *last = row.map_or(*last, |row| row.1);
    }
    words
}

const ORDINALS: [(&str, &str); 32] = [
    ("zero", "zeroth"),
    ("one", "first"),
    ("two", "second"),
    ("three", "third"),
    ("four", "fourth"),
    ("five", "fifth"),
    ("six", "sixth"),
    ("seven", "seventh"),
    ("eight", "eighth"),
    ("nine", "ninth"),
    ("ten", "tenth"),
    ("eleven", "eleventh"),
    ("twelve", "twelfth"),
    ("thirteen", "thirteenth"),
    ("fourteen", "fourteenth"),
    ("fifteen", "fifteenth"),
    ("sixteen", "sixteenth"),
    ("seventeen", "seventeenth"),
    ("eighteen", "eighteenth"),
    ("nineteen", "nineteenth"),
    ("twenty", "twentieth"),
    ("thirty", "thirtieth"),
    ("forty", "fortieth"),
    ("fifty", "fiftieth"),
    ("sixty", "sixtieth"),
    ("seventy", "seventieth"),
    ("eighty", "eightieth"),
    ("ninety", "ninetieth"),
    ("hundred", "hundredth"),
    ("thousand", "thousandth"),
    ("million", "millionth"),
    ("billion", "billionth"),
];
