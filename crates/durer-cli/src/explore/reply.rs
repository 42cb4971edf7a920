//! The part of HTTP (RFC 9110, 9112) that static pages need: GET and HEAD of files, one request a connection.

use super::pages::Pages;
use std::io::Read;

/// The longest head of a request; browsers send about 1,000 bytes.
const MOST_BYTES: usize = 16 << 10;

/// Reads the head of a request, up to its empty line; `None` for one that ends before, is too long, or is not text.
pub fn head(stream: &mut impl Read) -> Option<String> {
    let mut bytes = Vec::new();
    let mut piece = [0; 1024];
    while !bytes.windows(4).any(|end| end == b"\r\n\r\n") {
        let count = stream.read(&mut piece).ok().filter(|count| *count > 0)?;
        bytes.extend_from_slice(piece.get(..count)?);
        if bytes.len() > MOST_BYTES {
            return None;
        }
    }
    String::from_utf8(bytes).ok()
}

/// Returns the whole reply to a request.
pub fn reply(head: &str, pages: &Pages) -> Vec<u8> {
    let mut words = head.lines().next().unwrap_or_default().split(' ');
    let (method, target) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    if !matches!(method, "GET" | "HEAD") {
        return plain("405 Method Not Allowed", "only GET and HEAD");
    }
    // Pages of other sites reach this machine by names of their own, which this one does not have.
    if !is_local(head) {
        return plain("403 Forbidden", "this server is for its own machine");
    }
    let path = target.split(['?', '#']).next().unwrap_or_default().trim_start_matches('/');
    let index = format!("{path}index.html");
    let path = if path.is_empty() || path.ends_with('/') { &index } else { path };
    match pages.file(path) {
        Some(bytes) => {
            let mut reply = start("200 OK", kind(path), bytes.len());
            if method == "GET" {
                reply.extend(bytes);
            }
            reply
        }
        None => plain("404 Not Found", "no such file"),
    }
}

/// Returns whether a request names this machine as its host.
fn is_local(head: &str) -> bool {
    let host = head.lines().find_map(|line| {
        let (name, value) = line.split_once(':')?;
        name.eq_ignore_ascii_case("host").then_some(value.trim())
    });
    let name = host.unwrap_or_default().rsplit_once(':').map_or(host.unwrap_or_default(), |h| h.0);
    matches!(name, "127.0.0.1" | "localhost")
}

fn start(status: &str, kind: &str, length: usize) -> Vec<u8> {
    format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nCache-Control: no-cache\r\n\
         X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n"
    )
    .into_bytes()
}

fn plain(status: &str, text: &str) -> Vec<u8> {
    let mut reply = start(status, "text/plain; charset=utf-8", text.len());
    reply.extend(text.bytes());
    reply
}

/// Returns the media type of a file by its suffix.
fn kind(path: &str) -> &'static str {
    match path.rsplit_once('.').map_or("", |(_, suffix)| suffix) {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "svg" => "image/svg+xml",
        "wasm" => "application/wasm",
        "json" => "application/json",
        "png" => "image/png",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn reply_to(request: &str) -> String {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/explore");
        let mut bytes = request.as_bytes();
        let head = head(&mut bytes).expect("a head");
        String::from_utf8_lossy(&reply(&head, &Pages::Folder(folder.into()))).into_owned()
    }

    #[test]
    fn files_are_read_and_nothing_else() {
        let found = reply_to("GET /mod.rs?x=1 HTTP/1.1\r\nHost: localhost:80\r\n\r\n");
        assert!(found.starts_with("HTTP/1.1 200 OK\r\n") && found.contains("durer explore"));
        let head = reply_to("HEAD /mod.rs HTTP/1.1\r\nhost: 127.0.0.1\r\n\r\n");
        assert!(head.starts_with("HTTP/1.1 200") && head.ends_with("\r\n\r\n"));
        for (request, status) in [
            ("GET /../lib.rs HTTP/1.1\r\nHost: localhost\r\n\r\n", "404"),
            ("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n", "404"),
            ("GET //etc/passwd HTTP/1.1\r\nHost: localhost\r\n\r\n", "404"),
            ("POST /mod.rs HTTP/1.1\r\nHost: localhost\r\n\r\n", "405"),
            ("GET /mod.rs HTTP/1.1\r\nHost: example.org\r\n\r\n", "403"),
            ("GET /mod.rs HTTP/1.1\r\n\r\n", "403"),
            ("\r\n\r\n", "405"),
        ] {
            assert!(reply_to(request).starts_with(&format!("HTTP/1.1 {status} ")), "{request}");
        }
    }

    #[test]
    fn heads_end_and_are_short() {
        assert_eq!(head(&mut &b"GET / HTTP/1.1\r\n"[..]), None);
        assert_eq!(head(&mut std::io::repeat(b'a')), None);
        assert_eq!(head(&mut &b"\xff\r\n\r\n"[..]), None);
    }
}
