//! The landmarks in words, and the order in which a person best places them.
//!
//! Names are Farkas's (Anthropometry of the Head and Face, 1994); the descriptions are ours. A head may have other
//! landmarks too: they come last and are described by their name alone.

/// What to place first: few clear points that say where the head is, then what bounds the features, then the rest.
const ORDER: [&str; 38] = [
    "prn", "en", "ex", "ch", "sn", "n", "gn", "t", "al", "ls", "li", "sto", "pg", "g", "tr", "go",
    "zy", "v", "op", "ft", "eu", "sa", "sba", "pa", "ps", "pi", "cph", "sl", "or", "sci", "ac",
    "sbal", "c'", "se", "pra", "obs", "obi", "c_neck",
];

/// Title and place of each, by its name without the side.
const WORDS: [(&str, &str, &str); 38] = [
    (
        "v",
        "Vertex",
        "the highest point of the head when it looks straight ahead",
    ),
    (
        "g",
        "Glabella",
        "the most forward point between the brows, on the midline",
    ),
    (
        "op",
        "Opisthocranion",
        "the point at the back of the head farthest from the glabella",
    ),
    (
        "eu",
        "Eurion",
        "where the skull is widest, above and behind the ear",
    ),
    (
        "ft",
        "Frontotemporale",
        "the side of the forehead, where the ridge above the brow's tail turns inwards most",
    ),
    (
        "tr",
        "Trichion",
        "the hairline in the middle of the forehead",
    ),
    (
        "zy",
        "Zygion",
        "the outermost point of the cheek bone's arch",
    ),
    ("go", "Gonion", "the corner of the lower jaw, below the ear"),
    (
        "sl",
        "Sublabiale",
        "the deepest point of the furrow between lower lip and chin",
    ),
    ("pg", "Pogonion", "the most forward point of the chin"),
    (
        "gn",
        "Gnathion",
        "the lowest point of the chin's edge, on the midline",
    ),
    (
        "c_neck",
        "Cervical point",
        "the deepest point between the underside of the chin and the neck",
    ),
    (
        "en",
        "Endocanthion",
        "the inner corner of the eye, where the lids meet",
    ),
    (
        "ex",
        "Exocanthion",
        "the outer corner of the eye, where the lids meet",
    ),
    (
        "or",
        "Orbitale",
        "the lowest point of the bony rim under the eye",
    ),
    (
        "ps",
        "Palpebrale superius",
        "the highest point of the upper lid's free edge",
    ),
    (
        "pi",
        "Palpebrale inferius",
        "the lowest point of the lower lid's free edge",
    ),
    (
        "sci",
        "Superciliare",
        "the highest point of the brow's upper edge",
    ),
    (
        "n",
        "Nasion",
        "the root of the nose, on the midline, where the forehead's bone meets the nose's",
    ),
    (
        "se",
        "Sellion",
        "the deepest point of the saddle between forehead and nose",
    ),
    ("al", "Alare", "the outermost point of the nostril's wing"),
    ("prn", "Pronasale", "the tip of the nose"),
    (
        "sn",
        "Subnasale",
        "where the partition between the nostrils meets the upper lip",
    ),
    (
        "sbal",
        "Subalare",
        "where the wing of the nostril ends in the upper lip",
    ),
    (
        "ac",
        "Alar crease",
        "the rearmost point of the crease in which the nostril's wing meets the cheek",
    ),
    (
        "c'",
        "Columella",
        "the forward end of the partition between the nostrils, where the nostrils' rims are highest",
    ),
    (
        "cph",
        "Crista philtri",
        "the peak of the Cupid's bow, where the ridge of the philtrum meets the red of the lip",
    ),
    (
        "ls",
        "Labiale superius",
        "the middle of the upper lip's red edge",
    ),
    (
        "li",
        "Labiale inferius",
        "the middle of the lower lip's red edge",
    ),
    (
        "sto",
        "Stomion",
        "the middle of the line where the closed lips meet",
    ),
    ("ch", "Cheilion", "the corner of the mouth"),
    ("sa", "Superaurale", "the highest point of the ear"),
    ("sba", "Subaurale", "the lowest point of the ear lobe"),
    (
        "pra",
        "Preaurale",
        "the front of the ear, where it is joined to the head",
    ),
    ("pa", "Postaurale", "the rearmost point of the ear's rim"),
    (
        "obs",
        "Otobasion superius",
        "the upper end of the line along which the ear is joined to the head",
    ),
    (
        "obi",
        "Otobasion inferius",
        "the lower end of that line, where the lobe is joined to the cheek",
    ),
    (
        "t",
        "Tragion",
        "the notch just above the tragus, the small flap before the ear's opening",
    ),
];

/// Which side of the subject a landmark is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// `_l`.
    Left,
    /// `_r`.
    Right,
}

/// A landmark in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Words {
    /// As in anatomy books.
    pub title: String,
    /// Where it lies.
    pub place: String,
}

/// A name without its side, and the side.
#[must_use]
pub fn split(name: &str) -> (&str, Option<Side>) {
    if let Some(base) = name.strip_suffix("_l") {
        (base, Some(Side::Left))
    } else if let Some(base) = name.strip_suffix("_r") {
        (base, Some(Side::Right))
    } else {
        (name, None)
    }
}

/// The same landmark of the other side.
#[must_use]
pub fn opposite(name: &str) -> Option<String> {
    match split(name) {
        (base, Some(Side::Left)) => Some(format!("{base}_r")),
        (base, Some(Side::Right)) => Some(format!("{base}_l")),
        (_, None) => None,
    }
}

/// What a landmark is.
#[must_use]
pub fn words(name: &str) -> Words {
    let (base, side) = split(name);
    let side = match side {
        Some(Side::Left) => ", the subject's left",
        Some(Side::Right) => ", the subject's right",
        None => "",
    };
    match WORDS.iter().find(|(known, ..)| *known == base) {
        Some((_, title, place)) => Words {
            title: (*title).to_owned(),
            place: format!("{place}{side}"),
        },
        None => Words {
            title: name.to_owned(),
            place: format!("a landmark of this head alone{side}"),
        },
    }
}

/// Sorts by what to place first; of a pair the left one.
pub(super) fn rank(name: &str) -> (usize, bool) {
    let (base, side) = split(name);
    let place = ORDER.iter().position(|o| *o == base);
    (place.unwrap_or(ORDER.len()), side == Some(Side::Right))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_landmark_of_the_order_is_described_once() {
        for base in ORDER {
            let found = WORDS.iter().filter(|(known, ..)| *known == base).count();
            assert_eq!(found, 1, "{base}");
        }
    }
}
