//! The memory of the machine and of the process, where Linux reports it.

use std::fs;
use std::path::{Component, Path};

/// Largest budget without an option.
const MOST: u64 = 4 << 30;

/// Returns the budget if none is given: half of what the machine, its control group or the limits of the
/// process allow.
pub fn usual_budget() -> u64 {
    usual_budget_of(1)
}

/// Returns the budget of one of several processes that share the memory.
pub fn usual_budget_of(processes: u64) -> u64 {
    let read = |path: &str| fs::read_to_string(path).ok();
    let machine = read("/proc/meminfo").and_then(|text| kilobytes(&text, "MemTotal:"));
    let process = read("/proc/self/limits").and_then(|text| address_space(&text));
    let groups = read("/proc/self/cgroup").map_or(Vec::new(), |text| group_files(&text));
    let groups = groups.iter().filter_map(|path| read(path)?.trim().parse().ok());
    let least = machine.into_iter().chain(process).chain(groups).min();
    least.map_or(MOST, |bytes| (bytes / 2 / processes.max(1)).min(MOST))
}

/// Returns the bytes of memory that the process holds now.
pub fn held() -> Option<u64> {
    kilobytes(&fs::read_to_string("/proc/self/status").ok()?, "RssAnon:")
}

/// Returns a number of kilobytes, in bytes, behind a name at the start of a line.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(name))?;
    rest.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// Returns the soft limit of the address space, as `ulimit -v` sets it.
fn address_space(limits: &str) -> Option<u64> {
    let rest = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    rest.split_whitespace().next()?.parse().ok()
}

/// Returns the files that may say how much the control groups of the process allow: its own, of both
/// versions, and those above it.
fn group_files(groups: &str) -> Vec<String> {
    let mut files = Vec::new();
    for line in groups.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(kinds), Some(path)) = (parts.next(), parts.next()) else { continue };
        let (root, file) = match kinds {
            "" => ("/sys/fs/cgroup", "memory.max"),
            _ if kinds.split(',').any(|kind| kind == "memory") => {
                ("/sys/fs/cgroup/memory", "memory.limit_in_bytes")
            }
            _ => continue,
        };
        let path = Path::new(path);
        // Within a container the path may lead outside the mounted folders.
        if path.components().any(|part| part == Component::ParentDir) {
            files.push(format!("{root}/{file}"));
            continue;
        }
        for folder in path.ancestors() {
            let folder = folder.to_string_lossy();
            files.push(format!("{root}{}/{file}", folder.trim_end_matches('/')));
        }
    }
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found() {
        let text = "MemFree:  12 kB\nMemTotal:       24672276 kB\n";
        assert_eq!(kilobytes(text, "MemTotal:"), Some(24_672_276 * 1024));
        assert_eq!(kilobytes(text, "RssAnon:"), None);
        let limits =
            "Limit  Soft Limit  Hard Limit  Units\nMax address space  4096000000  unlimited bytes";
        assert_eq!(address_space(limits), Some(4_096_000_000));
        assert_eq!(address_space("Max address space  unlimited  unlimited bytes"), None);
    }

    #[test]
    fn groups_and_those_above_them_are_read() {
        let v2 =
            "/sys/fs/cgroup/a/b/memory.max /sys/fs/cgroup/a/memory.max /sys/fs/cgroup/memory.max";
        assert_eq!(group_files("0::/a/b\n"), v2.split(' ').collect::<Vec<_>>());
        let v1 = "9:cpu,cpuacct:/x\n4:memory:/d\n";
        let files = ["/sys/fs/cgroup/memory/d/", "/sys/fs/cgroup/memory/"];
        assert_eq!(group_files(v1), files.map(|f| format!("{f}memory.limit_in_bytes")));
        assert_eq!(group_files("0::/../x"), ["/sys/fs/cgroup/memory.max"]);
    }

    #[test]
    fn there_is_a_budget() {
        assert!((1 << 20..=MOST).contains(&usual_budget()));
    }
}
