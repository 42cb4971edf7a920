//! Prints the checksums; with the name of a SIMD level, those at that level, and with `levels` the names that there are.

use durer::simd::{by_name, levels, name, set_default_level};

/// Unoptimized code needs much stack.
const STACK: usize = 64 << 20;

fn main() {
    let known = levels().into_iter().map(name).collect::<Vec<_>>().join(" ");
    let wanted = std::env::args().nth(1);
    if wanted.as_deref() == Some("levels") {
        return println!("{known}");
    }
    if let Some(wanted) = wanted {
        let level = by_name(&wanted).unwrap_or_else(|| panic!("this machine has {known}"));
        assert!(set_default_level(level), "something was made before");
    }
    let made = std::thread::Builder::new().stack_size(STACK).spawn(peers_machines::sums::all);
    for (name, sum) in made.expect("a thread").join().expect("checksums") {
        println!("{sum:016x} {name}");
    }
}
