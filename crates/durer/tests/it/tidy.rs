//! Invariants of the source itself: dependencies run one way, no file is opened, nothing is printed.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

fn sources(dir: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(dir).expect("source folder") {
        let path = entry.expect("entry").path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

fn library() -> (PathBuf, Vec<PathBuf>) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    sources(&root, &mut found);
    found.sort();
    assert!(found.len() > 10, "sources not found under {}", root.display());
    (root, found)
}

/// Returns the code lines of a file: without comments, up to its test module.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("source");
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    text.lines().filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

#[test]
fn library_touches_no_file_and_prints_nothing() {
    let (_, files) = library();
    for path in files {
        let code = code(&path);
        for forbidden in [
            "std::fs",
            "std::net",
            "std::process",
            "std::env",
            "println!",
            "print!(",
            "dbg!",
            "todo!(",
            "unimplemented!(",
        ] {
            assert!(!code.contains(forbidden), "{} uses {forbidden}", path.display());
        }
    }
}

#[test]
fn dependencies_run_in_the_order_of_the_modules() {
    let (root, files) = library();
    let lib = fs::read_to_string(root.join("lib.rs")).expect("lib.rs");
    let order: Vec<&str> = lib
        .lines()
        .filter_map(|l| l.strip_prefix("pub mod ").or_else(|| l.strip_prefix("mod ")))
        .map(|l| l.trim_end_matches(';'))
        .collect();
    let rank = |module: &str| order.iter().position(|m| *m == module);
    for path in files {
        let relative = path.strip_prefix(&root).expect("below src");
        let first = relative.components().next().expect("component").as_os_str();
        let own = first.to_string_lossy().trim_end_matches(".rs").to_owned();
        let Some(own_rank) = rank(&own) else { continue };
        for piece in code(&path).split("crate::").skip(1) {
            let name: String =
                piece.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            if let Some(used) = rank(&name) {
                assert!(
                    used <= own_rank,
                    "{}: `{own}` uses `{name}`, which comes later",
                    relative.display()
                );
            }
        }
    }
}

/// Checks that everything that names its cost and can be called is an algorithm and has its facts.
#[test]
fn every_algorithm_has_its_facts() {
    let (_, files) = library();
    let mut found = 0;
    for path in files {
        let text = fs::read_to_string(&path).expect("source");
        let header: String = text.lines().take_while(|l| l.starts_with("//!")).collect();
        let called = text.lines().any(|l| l.starts_with("pub fn "));
        if called && header.contains("Cost:") && !header.contains("The method is in") {
            assert!(text.contains(": Info = Info {"), "{} has no INFO", path.display());
            found += 1;
        }
    }
    assert!(found > 25, "only {found} algorithms found");
}

/// Checks that all algorithms can be listed from one place, each with its facts.
#[test]
fn every_algorithm_is_in_the_catalogue() {
    let (_, files) = library();
    let of = |path: &PathBuf| {
        let text = fs::read_to_string(path).expect("source");
        text.lines()
            .filter(|l| l.starts_with("pub const ") && l.ends_with(": Info = Info {"))
            .count()
    };
    let listed = durer::explain::ALGORITHMS;
    assert_eq!(files.iter().map(of).sum::<usize>(), listed.len(), "explain::ALGORITHMS");
    for (i, info) in listed.iter().enumerate() {
        assert!(!listed[..i].iter().any(|other| other.title == info.title && other == info));
        let texts = [info.name, info.title, info.authors, info.source, info.cost, info.limits];
        assert!(texts.iter().all(|text| !text.is_empty()), "{}", info.title);
        let kinds = info.coherence;
        assert!((1..kinds.len()).all(|k| !kinds[k..].contains(&kinds[k - 1])), "{}", info.title);
        // Descartes is the oldest.
        assert!((1637..2100).contains(&info.year), "{}", info.title);
    }
}

/// Checks that comments begin with a noun for types, values and modules, and with a verb for functions.
#[test]
fn doc_comments_begin_with_nouns_and_verbs() {
    const CLAUSES: [&str; 8] =
        ["What", "Of", "How", "Where", "Whether", "Which", "So many", "As many"];
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = Vec::new();
    for name in ["durer", "durer-formats", "durer-cli"] {
        sources(&crates.join(name), &mut files);
    }
    let mut wrong = Vec::new();
    for path in files {
        let text = fs::read_to_string(&path).expect("source");
        let mut before = "";
        for (number, line) in text.lines().map(str::trim_start).enumerate() {
            let comment = line.strip_prefix("/// ").or_else(|| line.strip_prefix("//! "));
            let begins = !before.starts_with("///") && !before.starts_with("//!");
            let first = comment.filter(|_| begins).unwrap_or_default();
            if CLAUSES.iter().any(|clause| first.starts_with(&format!("{clause} "))) {
                wrong.push(format!("{}:{}: {first}", path.display(), number + 1));
            }
            before = line;
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Returns the doc comments of a file's functions: the line and the first word of each, up to the test module.
fn docs_of_functions(text: &str) -> Vec<(usize, String)> {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let (mut found, mut first) = (Vec::new(), None);
    for (number, line) in text.lines().map(str::trim_start).enumerate() {
        if let Some(comment) = line.strip_prefix("///") {
            let word = comment.split_whitespace().next().unwrap_or_default();
            first.get_or_insert((number + 1, word.to_owned()));
        } else if !line.starts_with("#[") {
            let item =
                line.strip_prefix("pub(").and_then(|l| l.split_once(") ")).map_or(line, |(_, l)| l);
            let before = ["pub", "const", "async", "unsafe", "extern", "\"C\""];
            let keyword = item.split(' ').find(|word| !before.contains(word));
            found.extend(first.take().filter(|_| keyword == Some("fn")));
        }
    }
    found
}

/// Checks that the docs of functions begin with a verb in the third person: "Returns …", "Clips …".
#[test]
fn docs_of_functions_begin_with_a_verb() {
    // Words that end like verbs, but begin a noun phrase.
    const NOUNS: &str = "Bits Bytes Cells Colours Columns Coordinates Depths Edges Faces Fragments Indices Items \
                         Lengths Normals Pixels Points Positions Rows Sides This Weights";
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = Vec::new();
    for name in ["durer", "durer-formats", "durer-cli", "durer-wasm"] {
        sources(&crates.join(name).join("src"), &mut files);
    }
    let mut wrong = Vec::new();
    for path in
        files.iter().filter(|path| !path.iter().any(|part| part == "tests" || part == "tests.rs"))
    {
        let text = fs::read_to_string(path).expect("source");
        for (line, word) in docs_of_functions(&text) {
            let word = word.trim_end_matches([',', '.']);
            let is_verb = word.starts_with(char::is_uppercase) && word.ends_with('s');
            if !is_verb || NOUNS.split(' ').any(|noun| noun == word) {
                wrong.push(format!("{}:{line}: {word}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{} functions:\n{}", wrong.len(), wrong.join("\n"));
}

/// Checks that names are the usual words for what they name: warnings are reported, systems are stated, options are
/// requested.
#[test]
fn names_are_the_usual_words() {
    const VAGUE: [&str; 3] = ["asked", "tell", "told"];
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = Vec::new();
    for name in ["durer", "durer-formats", "durer-cli", "durer-wasm"] {
        sources(&crates.join(name), &mut files);
    }
    let mut wrong = Vec::new();
    for path in files {
        let text = fs::read_to_string(&path).expect("source");
        for (number, line) in text.lines().enumerate() {
            // Text between quotes and comments are prose.
            let code = line.split("//").next().unwrap_or_default();
            let code: String = code.split('"').step_by(2).collect();
            let mut names = code.split(|c: char| !c.is_alphanumeric() && c != '_');
            let is_vague = |name: &str| {
                VAGUE.contains(&name)
                    || name.split('_').any(|part| ["asked", "told"].contains(&part))
            };
            if names.any(is_vague) {
                wrong.push(format!("{}:{}: {}", path.display(), number + 1, line.trim()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Adds the types that a caller reaches through a file's public modules: those that it defines, and those that it takes
/// from its private modules.
fn public_types(path: &Path, folder: &Path, found: &mut BTreeMap<String, Vec<PathBuf>>) {
    let text = code(path);
    let mut add = |name: &str| found.entry(name.to_owned()).or_default().push(path.to_owned());
    let word = |rest: &str| -> String {
        rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    for kind in ["struct", "enum", "trait", "type"] {
        let start = format!("pub {kind} ");
        text.lines().filter_map(|l| l.strip_prefix(&start)).for_each(|rest| add(&word(rest)));
    }
    let lines = |start: &'static str| text.lines().filter_map(move |l| l.strip_prefix(start));
    let private: Vec<String> = lines("mod ").map(word).collect();
    for (i, _) in text.match_indices("\npub use ") {
        let (_, rest) = text[i..].split_once("use ").unwrap_or_default();
        let (from, names) =
            rest.split(';').next().and_then(|u| u.split_once("::")).unwrap_or_default();
        if private.iter().any(|name| name == from) {
            let names = names.split(|c: char| !c.is_alphanumeric() && c != '_');
            let is_type = |name: &&str| {
                name.starts_with(char::is_uppercase) && name.contains(char::is_lowercase)
            };
            names.filter(is_type).for_each(&mut add);
        }
    }
    for name in lines("pub mod ").map(word) {
        let inner = folder.join(&name);
        let file = inner.with_extension("rs");
        let file = if file.exists() { file } else { inner.join("mod.rs") };
        if file.exists() {
            public_types(&file, &inner, found);
        }
    }
}

/// Checks that no two public types have one name, but for those that every algorithm has.
#[test]
fn public_types_have_names_of_their_own() {
    const OF_ALGORITHMS: [&str; 2] = ["Options", "Step"];
    let (root, _) = library();
    let mut found = BTreeMap::new();
    public_types(&root.join("lib.rs"), &root, &mut found);
    assert!(found.len() > 300, "{} types", found.len());
    found.retain(|name, places| places.len() > 1 && !OF_ALGORITHMS.contains(&&name[..]));
    assert!(found.is_empty(), "{found:#?}");
}

/// Files and folders by their paths as modules.
type Modules = BTreeMap<Vec<String>, PathBuf>;

/// Returns the modules of a crate, without those of tests.
fn modules(root: &Path) -> Modules {
    let mut files = Vec::new();
    sources(root, &mut files);
    files.retain(|path| !path.ends_with("tests.rs"));
    let module = |path: PathBuf| {
        let relative = path.strip_prefix(root).expect("below src").with_extension("");
        let parts = relative.components().map(|c| c.as_os_str().to_string_lossy().into_owned());
        let mut parts: Vec<String> = parts.collect();
        if ["mod", "lib", "main"].contains(&parts.last().expect("a name").as_str()) {
            parts.pop();
        }
        (parts, path)
    };
    files.into_iter().map(module).collect()
}

/// Returns the paths that begin with `crate`, `super` or `self` in the code of a module.
fn paths(code: &str, module: &[String]) -> Vec<Vec<String>> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = Vec::new();
    for start in ["crate::", "super::", "self::"] {
        for (at, _) in code.match_indices(start) {
            if code[..at].ends_with(|c: char| is_name(c) || c == ':') {
                continue;
            }
            let (mut rest, mut path) = (&code[at..], Vec::from(module));
            while let Some((name, after)) =
                rest.split_once("::").filter(|(name, _)| name.chars().all(is_name))
            {
                match name {
                    "crate" => path.clear(),
                    "super" => drop(path.pop()),
                    "self" => {}
                    name => path.push(name.to_owned()),
                }
                rest = after;
            }
            let heads = match rest.strip_prefix('{') {
                Some(group) => heads(group),
                None => vec![rest.split(|c| !is_name(c)).next().unwrap_or_default()],
            };
            found.extend(heads.into_iter().map(|head| [&path[..], &[head.to_owned()]].concat()));
        }
    }
    found
}

/// Returns the first names of the members of a group of a `use`, which ends at its brace.
fn heads(group: &str) -> Vec<&str> {
    let (mut heads, mut depth, mut start) = (Vec::new(), 0, 0);
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' | ',' if depth == 0 => {
                let member = group[start..at].trim();
                heads.push(member.split([':', ' ']).next().unwrap_or_default());
                start = at + 1;
                if c == '}' {
                    break;
                }
            }
            '}' => depth -= 1,
            _ => {}
        }
    }
    heads
}

/// Returns the uses between neighbours in the same folder, folder by folder: below `a`, `b::c` uses `d` where `a::b::c`
/// uses `a::d`.
fn neighbours(modules: &Modules) -> BTreeMap<Vec<String>, BTreeSet<[String; 2]>> {
    let mut folders = BTreeMap::<_, BTreeSet<[String; 2]>>::new();
    for (module, path) in modules {
        for mut used in paths(&code(path), module) {
            while !used.is_empty() && !modules.contains_key(&used) {
                used.pop();
            }
            let common = module.iter().zip(&used).take_while(|(a, b)| a == b).count();
            if let (Some(from), Some(to)) = (module.get(common), used.get(common)) {
                let arrows = folders.entry(module[..common].to_vec()).or_default();
                arrows.insert([from.clone(), to.clone()]);
            }
        }
    }
    folders
}

/// Checks that files and folders beside each other do not use each other in a circle.
#[test]
fn no_circles_between_neighbours() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for name in ["durer", "durer-formats", "durer-cli"] {
        let folders = neighbours(&modules(&crates.join(name).join("src")));
        assert!(folders.values().map(BTreeSet::len).sum::<usize>() > 50, "{name}: none found");
        for (folder, mut arrows) in folders {
            // A module that uses only modules without uses is in no circle.
            loop {
                let before = arrows.len();
                let users: BTreeSet<String> = arrows.iter().map(|[from, _]| from.clone()).collect();
                arrows.retain(|[_, to]| users.contains(to));
                if arrows.len() == before {
                    break;
                }
            }
            assert!(arrows.is_empty(), "{name}, in {folder:?}: {arrows:?}");
        }
    }
}
