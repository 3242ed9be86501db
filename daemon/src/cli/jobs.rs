//! Words of the command line for many videos at once.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

/// Many videos.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Many videos")]
pub struct JobsArgs {
    /// Make a video of each row of a list, .csv or .ndjson, whose columns are named as the options above
    ///
    /// Options beside it hold for every row that does not say otherwise. Files in the list are relative to its
    /// folder. What is finished stays: the same command again makes only what is missing or has changed.
    #[arg(long, value_name = "LIST", conflicts_with = "output")]
    pub jobs: Option<PathBuf>,
    /// What the outputs in the list are relative to [default: the list's folder]
    #[arg(long, value_name = "DIR", requires = "jobs")]
    pub output_dir: Option<PathBuf>,
    /// Videos at once [default: as many as cores and free memory allow]
    #[arg(long, value_name = "N", requires = "jobs",
          value_parser = clap::value_parser!(u16).range(1..=256))]
    pub parallel: Option<u16>,
    /// Only every Nth row, from row I on (both counted from 0): one machine's share of a list
    #[arg(long, value_name = "I/N", requires = "jobs")]
    pub shard: Option<Shard>,
    /// Write what became of each row, .json or .ndjson
    #[arg(long, value_name = "F", requires = "jobs")]
    pub report: Option<PathBuf>,
}

/// One share of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    pub index: u32,
    pub count: u32,
}

impl Shard {
    /// More machines than any cluster that we heard of has.
    const COUNT_MAX: u32 = 100_000;

    /// Whether the row with this number, from 0, is in it.
    pub fn has(self, row: usize) -> bool {
        row % self.count as usize == self.index as usize
    }
}

impl FromStr for Shard {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text
            .split_once('/')
            .and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        match numbers {
            Some((index, count)) if index < count && count <= Self::COUNT_MAX => {
                Ok(Self { index, count })
            }
            Some((_, count)) if (1..=Self::COUNT_MAX).contains(&count) => Err(format!(
                "shards count from 0: the last of {count} is {}/{count}",
                count - 1
            )),
            _ => Err("write it as I/N, like 0/4 for the first of four".into()),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_in_one_shard() {
        let shards: Vec<Shard> = (0..3).map(|i| format!("{i}/3").parse().unwrap()).collect();
        for row in 0..100 {
            assert_eq!(shards.iter().filter(|shard| shard.has(row)).count(), 1);
        }
        for bad in ["3/3", "1", "/", "1/0", "-1/3", "0/1000000", "a/b"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }
}
