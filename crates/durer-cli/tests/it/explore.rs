//! `durer explore`: pages served on this machine.

use crate::harness::Folder;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};

/// A server that is stopped at the end of the test.
struct Served(Child);

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn pages_of_a_folder_are_served() {
    let folder = Folder::new();
    folder.write("index.html", "<title>pages</title>");
    std::fs::create_dir(folder.path("de")).unwrap();
    folder.write("de/index.html", "<title>Seiten</title>");
    folder.write("durer.wasm", b"\0asm");
    let mut command = folder.command("explore --no-open --from .");
    let mut served = Served(command.stdout(Stdio::piped()).spawn().unwrap());
    let mut line = String::new();
    BufReader::new(served.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let host = line.split("http://").nth(1).and_then(|rest| rest.split('/').next()).unwrap();
    let get = |path: &str| {
        let mut stream = TcpStream::connect(host).unwrap();
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        let mut reply = String::new();
        stream.read_to_string(&mut reply).unwrap();
        reply
    };
    assert!(get("/").ends_with("<title>pages</title>"));
    // A frame in a page of another site requests the same file.
    assert!(get("/?embed").ends_with("<title>pages</title>"));
    assert!(get("/de/").ends_with("<title>Seiten</title>"));
    let module = get("/durer.wasm");
    assert!(module.contains("application/wasm") && module.ends_with("\0asm"), "{module}");
    assert!(get("/../explore.rs").starts_with("HTTP/1.1 404"));
}

#[test]
fn missing_pages_are_reported_where_they_come_from() {
    let folder = Folder::new();
    folder.run("explore --no-open --from .").fails(2, "index.html");
    #[cfg(not(feature = "explorer"))]
    folder.run("explore --no-open").fails(2, "--from DIR");
    folder.run("explore --port 99999").fails(2, "99999");
}
