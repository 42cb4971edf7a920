//! The share of the rows that a process runs.

use crate::failure::Failure;
use std::fmt;

/// A share of the rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Its number, from 0.
    index: u64,
    /// Number of all shards.
    count: u64,
}

/// Environment variables with the number of a job in an array: that number, the first one, and how many there are.
const ARRAYS: [[&str; 3]; 5] = [
    ["DURER_SHARD", "", SHARDS],
    ["SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_COUNT"],
    ["AWS_BATCH_JOB_ARRAY_INDEX", "", "AWS_BATCH_JOB_ARRAY_SIZE"],
    ["CLOUD_RUN_TASK_INDEX", "", "CLOUD_RUN_TASK_COUNT"],
    ["JOB_COMPLETION_INDEX", "", SHARDS],
];

/// Variable that overrides the job array's number of shards: for arrays that give no number, and when only some of the
/// jobs run again.
const SHARDS: &str = "DURER_SHARDS";

impl Shard {
    /// All rows.
    pub const ALL: Self = Self { index: 0, count: 1 };

    /// Parses `I/N`, or finds both in the environment for `auto`.
    pub fn parse(text: &str, variable: impl Fn(&str) -> Option<String>) -> Result<Self, Failure> {
        if text == "auto" {
            return Self::of_environment(variable);
        }
        let wrong = || {
            let what = "a shard is I/N with I below N, e.g. 0/8; or `auto`";
            Failure::Usage(format!("--shard {text}: {what}"))
        };
        let (index, count) = text.split_once('/').ok_or_else(wrong)?;
        let number = |text: &str| text.parse().map_err(|_| wrong());
        Self::new(number(index)?, number(count)?).ok_or_else(wrong)
    }

    fn new(index: u64, count: u64) -> Option<Self> {
        (index < count).then_some(Self { index, count })
    }

    fn of_environment(variable: impl Fn(&str) -> Option<String>) -> Result<Self, Failure> {
        let usage = |what: String| Failure::Usage(format!("--shard auto: {what}"));
        let found = ARRAYS.iter().find(|[index, ..]| variable(index).is_some());
        let Some(&[index, first, count]) = found else {
            let known = ARRAYS.map(|[index, ..]| index).join(", ");
            return Err(usage(format!("none of {known} is set; give I/N")));
        };
        let number = |name: &str| -> Result<u64, Failure> {
            let text = variable(name).ok_or_else(|| {
                usage(format!("{index} is set, {name} is not; set it to the number of jobs"))
            })?;
            text.trim().parse().map_err(|_| usage(format!("{name}={text} is not a number")))
        };
        let counted = variable(SHARDS).is_some();
        let least = if first.is_empty() || counted { 0 } else { number(first)? };
        let (at, count) = (number(index)?, number(if counted { SHARDS } else { count })?);
        let shard = at.checked_sub(least).and_then(|at| Self::new(at, count));
        shard.ok_or_else(|| {
            usage(format!("{index}={at} is not one of {count} numbers from {least} on"))
        })
    }

    /// Returns whether a row belongs to it, by the row's id alone.
    pub fn has(self, id: &str) -> bool {
        fnv1a64(id) % self.count == self.index
    }

    /// Returns the name of its files.
    pub fn file_name(self) -> String {
        format!("shard-{}-of-{}", self.index, self.count)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

/// Returns the hash FNV-1a of 64 bits (G. Fowler, L. C. Noll, P. Vo).
fn fnv1a64(text: &str) -> u64 {
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    text.bytes().fold(0xcbf2_9ce4_8422_2325, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_those_of_the_publication() {
        let known =
            [("", 0xcbf29ce484222325), ("a", 0xaf63dc4c8601ec8c), ("foobar", 0x85944171f73967e8)];
        known.iter().for_each(|&(text, hash)| assert_eq!(fnv1a64(text), hash, "{text}"));
    }

    #[test]
    fn each_row_is_in_one_shard() {
        let shards: Vec<Shard> = (0..7).filter_map(|index| Shard::new(index, 7)).collect();
        let mut counts = [0; 7];
        for row in 0..7000 {
            let id = format!("row-{row}");
            let of: Vec<usize> = (0..7).filter(|&i| shards[i].has(&id)).collect();
            assert_eq!(of.len(), 1);
            counts[of[0]] += 1;
        }
        assert!(counts.iter().all(|count| (850..1150).contains(count)), "{counts:?}");
    }

    #[test]
    fn shards_are_reported_by_words_or_by_the_environment() {
        let none = |_: &str| None;
        assert_eq!(Shard::parse("2/5", none).unwrap(), Shard { index: 2, count: 5 });
        for wrong in ["", "5/5", "1", "a/b", "-1/3", "0/0", "auto"] {
            assert!(Shard::parse(wrong, none).is_err(), "{wrong}");
        }
        let of = |set: &'static [(&str, &str)]| {
            let get = |name: &str| set.iter().find(|s| s.0 == name).map(|s| s.1.to_owned());
            Shard::parse("auto", get).map(|shard| shard.to_string()).map_err(|e| e.to_string())
        };
        let slurm = [
            ("SLURM_ARRAY_TASK_ID", "4"),
            ("SLURM_ARRAY_TASK_MIN", "1"),
            ("SLURM_ARRAY_TASK_COUNT", "8"),
        ];
        assert_eq!(of(Box::leak(Box::new(slurm))), Ok("3/8".to_owned()));
        let aws = [("AWS_BATCH_JOB_ARRAY_INDEX", "4"), ("AWS_BATCH_JOB_ARRAY_SIZE", "5")];
        assert_eq!(of(Box::leak(Box::new(aws))), Ok("4/5".to_owned()));
        let again = [slurm[0], slurm[1], ("SLURM_ARRAY_TASK_COUNT", "2"), ("DURER_SHARDS", "8")];
        assert_eq!(of(Box::leak(Box::new(again))), Ok("4/8".to_owned()));
        let kubernetes = of(&[("JOB_COMPLETION_INDEX", "4")]).unwrap_err();
        assert!(kubernetes.contains("DURER_SHARDS is not"), "{kubernetes}");
        assert!(of(&[("DURER_SHARD", "9"), ("DURER_SHARDS", "9")]).is_err());
    }
}
