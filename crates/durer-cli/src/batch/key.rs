//! Keys of rows: a hash of everything that the output depends on.

use super::task::Task;
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Hashes of files that several rows have in common.
#[derive(Debug, Default)]
pub struct Hashes(HashMap<PathBuf, (u64, Option<SystemTime>, String)>);

impl Hashes {
    /// Returns the hash of a file, from the cache if the file has not changed.
    pub fn of(&mut self, path: &Path) -> io::Result<String> {
        let metadata = std::fs::metadata(path)?;
        let (length, modified) = (metadata.len(), metadata.modified().ok());
        if let Some((known_length, known_modified, hash)) = self.0.get(path)
            && (*known_length, *known_modified) == (length, modified)
            && modified.is_some()
        {
            return Ok(hash.clone());
        }
        let (hash, _) = of_file(path)?;
        self.0.insert(path.to_owned(), (length, modified, hash.clone()));
        Ok(hash)
    }
}

/// Returns the hash of a file's content, in hexadecimal digits, and the number of bytes.
pub fn of_file(path: &Path) -> io::Result<(String, u64)> {
    let mut file = File::open(path)?;
    let (mut hash, mut length, mut buffer) = (Sha256::new(), 0, vec![0; 1 << 16]);
    loop {
        match file.read(&mut buffer) {
            Ok(0) => return Ok((in_digits(hash), length)),
            Ok(count) => {
                hash.update(&buffer[..count]);
                length += count as u64;
            }
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
}

/// Returns the key of a row whose inputs, and files that its options name, have these hashes.
pub fn of_row(task: &Task, inputs: &[(String, String)], files: &[(String, String)]) -> String {
    let mut options = task.options.clone();
    options.sort();
    let facts = serde_json::json!({
        "version": env!("CARGO_PKG_VERSION"),
        "command": task.command,
        "options": options,
        "output": task.output,
        "planes": task.planes,
        "inputs": inputs,
        "files": files,
    });
    in_digits(Sha256::new_with_prefix(facts.to_string()))
}

fn in_digits(hash: Sha256) -> String {
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_those_of_the_standard() {
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(in_digits(Sha256::new_with_prefix("abc")), abc);
    }

    #[test]
    fn keys_depend_on_all_that_matters() {
        let task = Task {
            id: "a".to_owned(),
            command: "render".to_owned(),
            options: vec![("size".to_owned(), vec!["--size=8".to_owned()])],
            inputs: vec!["x/a.obj".to_owned()],
            output: "a.png".to_owned(),
            planes: Vec::new(),
            sha256: None,
            known: None,
        };
        let file = |name: &str, hash: &str| [(name.to_owned(), hash.to_owned())];
        let of = |task: &Task| of_row(task, &file("a.obj", "1"), &[]);
        let key = of(&task);
        assert_eq!(key.len(), 64);
        let other = |change: fn(&mut Task)| {
            let mut task = task.clone();
            change(&mut task);
            of(&task)
        };
        assert_ne!(key, other(|t| t.command = "info".to_owned()));
        assert_ne!(key, other(|t| t.options.clear()));
        assert_ne!(key, other(|t| t.output = "a.svg".to_owned()));
        assert_ne!(key, other(|t| t.planes.push(("depth".to_owned(), "d.png".to_owned()))));
        assert_ne!(key, of_row(&task, &file("a.obj", "2"), &[]));
        assert_ne!(key, of_row(&task, &file("a.obj", "1"), &file("m.json", "1")));
        // The input counts by its content, not by its path.
        assert_eq!(key, other(|t| t.inputs = vec!["y/a.obj".to_owned()]));
        assert_eq!(key, other(|t| t.sha256 = Some("1".to_owned())));
    }
}
