//! Says how words sound, and how well: `pronounce WORD …` prints phones; `pronounce --against
//! cmudict.dict < text` counts the text's words that sound as that dictionary has them.

use std::collections::HashMap;
use std::io::{self, Read};

use mouthpiece_phonemes::pronounce::{Pronouncer, Said};

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn main() -> Outcome {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let [flag, file] = words.as_slice()
        && flag == "--against"
    {
        return against(file);
    }
    let pronouncer = Pronouncer::new();
    for word in words {
        println!("{word}: {}", written(&pronouncer.pronounce(&word)));
    }
    Ok(())
}

fn written(said: &[Said]) -> String {
    let codes: Vec<&str> = said.iter().map(|(phone, _)| phone.code()).collect();
    codes.join(" ")
}

fn against(file: &str) -> Outcome {
    let text = std::fs::read_to_string(file)?;
    let mut known: HashMap<String, Vec<String>> = HashMap::new();
    for line in text.lines() {
        let Some((word, _)) = line.split_once(' ') else {
            continue;
        };
        // Each line as a dictionary of its own, so that every variant counts.
        let mut one = Pronouncer::new();
        one.add_dictionary(line);
        let word = word.split('(').next().unwrap_or(word).to_lowercase();
        let said = written(&one.pronounce(&word));
        known.entry(word).or_default().push(said);
    }
    let mut spoken = String::new();
    io::stdin().read_to_string(&mut spoken)?;
    let pronouncer = Pronouncer::new();
    let (mut right, mut all, mut unknown) = (0, 0, 0);
    for word in spoken.split_whitespace() {
        let bare = word
            .trim_matches(|c: char| !c.is_alphanumeric())
            .to_lowercase();
        let Some(ways) = known.get(&bare) else {
            unknown += usize::from(!bare.is_empty());
            continue;
        };
        all += 1;
        let said = written(&pronouncer.pronounce(&bare));
        if ways.contains(&said) {
            right += 1;
        } else {
            println!("{bare}: {said} (not {})", ways.join(", "));
        }
    }
    println!("{right} of {all} words as the dictionary has them; {unknown} that it lacks");
    Ok(())
}
