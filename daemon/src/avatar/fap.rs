//! MPEG-4's facial animation parameters of the mouth (ISO/IEC 14496-2, annex C), as a .fap text:
//! `2.1 NAME RATE FRAMES`, then for each frame a line of 68 flags for what is given and a line with the
//! frame's number and the values of those.
//!
//! A parameter is how far a feature point has gone from its place in the neutral face, in
//! thousand-and-twenty-fourths of a distance of this face: the mouth's width (MW) across, from the
//! nose to the mouth (MNS) up, down and forward. The neutral face, teeth and lips together, is our
//! head at rest. Left and right are the subject's. Parameters of other parts of the face are not
//! given; ARKit's shapes have them.

use std::fmt::Write as _;
use std::sync::Arc;

use anyhow::Context as _;
use glam::Vec3;
use mouthpiece_rig::{Control, Head, KeyFrame, Layer, Stencils, lip_level};

use super::Rows;
use crate::cli::Fps;

/// How many parameters the standard has.
const COUNT: usize = 68;

/// A feature point that moves.
#[derive(Clone, Copy, Debug)]
enum Point {
    /// 2.1: the chin's lowest.
    Chin,
    /// Of the upper lip: level of its column, and quarters of the way from the right corner to the left.
    Upper(usize, usize),
    /// Of the lower lip.
    Lower(usize, usize),
}
use Point::{Chin, Lower, Upper};

/// Which way counts as more, and in which unit.
#[derive(Clone, Copy, Debug)]
enum Way {
    Up,
    Down,
    Forward,
    Left,
    Right,
}
use Way::{Down, Forward, Left, Right, Up};

const IN: usize = lip_level::CONTACT;
const OUT: usize = lip_level::BORDER;

/// Number, feature point and way of each parameter that is given, ascending.
const PARAMETERS: [(usize, Point, Way); 23] = [
    (3, Chin, Down),                           // open_jaw
    (4, Upper(IN, 2), Down),                   // lower_t_midlip
    (5, Lower(IN, 2), Up),                     // raise_b_midlip
    (6, Upper(IN, 4), Left),                   // stretch_l_cornerlip
    (7, Upper(IN, 0), Right),                  // stretch_r_cornerlip
    (8, Upper(IN, 3), Down),                   // lower_t_lip_lm
    (9, Upper(IN, 1), Down),                   // lower_t_lip_rm
    (10, Lower(IN, 3), Up),                    // raise_b_lip_lm
    (11, Lower(IN, 1), Up),                    // raise_b_lip_rm
    (12, Upper(IN, 4), Up),                    // raise_l_cornerlip
    (13, Upper(IN, 0), Up),                    // raise_r_cornerlip
    (16, Lower(lip_level::CREST, 2), Forward), // push_b_lip
    (17, Upper(lip_level::CREST, 2), Forward), // push_t_lip
    (51, Upper(OUT, 2), Down),                 // lower_t_midlip_o
    (52, Lower(OUT, 2), Up),                   // raise_b_midlip_o
    (53, Upper(OUT, 4), Left),                 // stretch_l_cornerlip_o
    (54, Upper(OUT, 0), Right),                // stretch_r_cornerlip_o
    (55, Upper(OUT, 3), Down),                 // lower_t_lip_lm_o
    (56, Upper(OUT, 1), Down),                 // lower_t_lip_rm_o
    (57, Lower(OUT, 3), Up),                   // raise_b_lip_lm_o
    (58, Lower(OUT, 1), Up),                   // raise_b_lip_rm_o
    (59, Upper(OUT, 4), Up),                   // raise_l_cornerlip_o
    (60, Upper(OUT, 0), Up),                   // raise_r_cornerlip_o
];

/// A head's parameters.
struct Reader {
    head: Arc<Head>,
    limit: Stencils,
    rest: Vec<Vec3>,
    skin: Vec<Vec3>,
    chin: Vec3,
    /// Nose to mouth, mm.
    mns: f32,
    /// Mouth's width, mm.
    mw: f32,
}

impl Reader {
    fn new(head: &Arc<Head>) -> anyhow::Result<Self> {
        let limit = head.skin_limit()?;
        let rest = head.drawn_rest();
        let mark = |name: &str| {
            let found = head
                .landmarks
                .iter()
                .find(|m| m.name == name && m.layer == Layer::Skin);
            let found = found.with_context(|| {
                format!("the head has no landmark `{name}`, which FAPs are measured from; mark it")
            })?;
            anyhow::Ok(found.at.on(&rest))
        };
        let (nose, chin) = (mark("sn")?, mark("gn")?);
        let mut reader = Self {
            head: Arc::clone(head),
            limit,
            skin: rest.clone(),
            rest: Vec::new(),
            chin,
            mns: 0.0,
            mw: 0.0,
        };
        let at = |point| reader.vertex(point).map(|v| rest[v]);
        let (Some(lip), Some(right), Some(left)) =
            (at(Upper(IN, 2)), at(Upper(OUT, 0)), at(Upper(OUT, 4)))
        else {
            anyhow::bail!(
                "the head has no lips to measure; build it anew with `mouthpiece head fit`"
            );
        };
        (reader.mns, reader.mw) = ((nose.y - lip.y).max(1.0), (left.x - right.x).max(1.0));
        reader.rest = rest;
        Ok(reader)
    }

    /// The skin vertex of a point of the lips.
    fn vertex(&self, point: Point) -> Option<usize> {
        let (columns, level, quarter) = match point {
            Chin => return None,
            Upper(level, quarter) => (&self.head.lips.upper, level, quarter),
            Lower(level, quarter) => (&self.head.lips.lower, level, quarter),
        };
        let column = columns.get(columns.len().checked_sub(1)? * quarter / 4)?;
        let v = column[level] as usize;
        (v < self.skin.len()).then_some(v)
    }

    /// The values of [`PARAMETERS`].
    fn values(&mut self, frame: &KeyFrame) -> [i32; PARAMETERS.len()] {
        self.limit.apply(&frame.skin, &mut self.skin);
        PARAMETERS.map(|(_, point, way)| {
            let gone = match self.vertex(point) {
                Some(v) => self.skin[v] - self.rest[v],
                None => {
                    let jaw = self.head.mandible(frame.state[Control::Jaw]);
                    jaw.transform_point3(self.chin) - self.chin
                }
            };
            let (mm, unit) = match way {
                Up => (gone.y, self.mns),
                Down => (-gone.y, self.mns),
                Forward => (gone.z, self.mns),
                Left => (gone.x, self.mw),
                Right => (-gone.x, self.mw),
            };
            (mm * 1024.0 / unit).round() as i32
        })
    }
}

/// A file being written.
pub struct Table {
    reader: Reader,
    rate: Fps,
}

impl Table {
    pub fn new(head: &Arc<Head>, rate: Fps) -> anyhow::Result<Self> {
        Ok(Self {
            reader: Reader::new(head)?,
            rate,
        })
    }
}

impl Rows for Table {
    fn header(&self, rows: u64) -> String {
        let rate = f64::from(self.rate.num) / f64::from(self.rate.den);
        format!("2.1 mouthpiece {rate} {rows}\n")
    }

    fn row(&mut self, k: u64, frame: &KeyFrame, out: &mut String) {
        let given = |number| PARAMETERS.iter().any(|(known, ..)| *known == number);
        for number in 1..=COUNT {
            out.push(if given(number) { '1' } else { '0' });
            out.push(if number < COUNT { ' ' } else { '\n' });
        }
        let _ = write!(out, "{k}");
        for value in self.reader.values(frame) {
            let _ = write!(out, " {value}");
        }
        out.push('\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::avatar::tests::held;
    use mouthpiece_phonemes::Phone;

    #[test]
    fn phones_move_the_points_that_they_are_known_by() {
        let (head, frames) = held(&[Phone::M, Phone::Aa, Phone::Uw]);
        let mut reader = Reader::new(&head).unwrap();
        let all: Vec<_> = frames.iter().map(|f| reader.values(f)).collect();
        let fap = |i: usize, number| {
            let found = PARAMETERS.iter().position(|(known, ..)| *known == number);
            all[i][found.unwrap()]
        };
        // What separates the inner lips is neither's way down nor up: MNS/1024 is some 0.02 mm.
        let gap = |i| -fap(i, 4) - fap(i, 5);
        let (m, aa, uw) = (0, 1, 2);
        assert!(gap(m).abs() < 60, "{}", gap(m));
        assert!(gap(aa) > 300, "{}", gap(aa));
        assert!(fap(aa, 3) > 200 && fap(aa, 3) > 2 * fap(uw, 3));
        assert!(fap(uw, 53) < -50 && fap(uw, 54) < -50);
        assert!(fap(uw, 16) > 50 && fap(uw, 17) > 50);
        assert!((fap(aa, 53) - fap(aa, 54)).abs() < 20, "both sides alike");
    }

    #[test]
    fn nothing_moves_at_rest_and_each_frame_says_what_it_gives() {
        let head = Arc::new(Head::reference().unwrap());
        let mut table = Table::new(&head, Fps { num: 25, den: 1 }).unwrap();
        let mut text = table.header(1);
        table.row(0, &head.rest_frame(), &mut text);
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert_eq!(lines[0], "2.1 mouthpiece 25 1");
        let flags: Vec<_> = lines[1].split(' ').collect();
        assert_eq!(flags.len(), COUNT);
        let given = flags.iter().filter(|flag| **flag == "1").count();
        assert_eq!(given, PARAMETERS.len());
        assert_eq!(flags[2], "1");
        let values: Vec<i32> = lines[2].split(' ').map(|v| v.parse().unwrap()).collect();
        assert_eq!(values, vec![0; 1 + given]);
        assert!(PARAMETERS.windows(2).all(|w| w[0].0 < w[1].0));
    }
}
