//! Errors as programs hand them on.

use durer_formats::{Error, NoResources, ReadOptions, read_model};
use std::io;

type Boxed = Box<dyn std::error::Error + Send + Sync + 'static>;

fn read(bytes: &[u8]) -> Result<u64, Boxed> {
    Ok(read_model(bytes, "a.obj", &NoResources, &ReadOptions::default())?.scene.triangle_count())
}

#[test]
fn errors_go_where_any_error_goes() {
    let error = read(b"v 1 2 x\n").expect_err("no number");
    assert!(matches!(error.downcast_ref(), Some(Error::Decode { .. })));
    assert!(error.source().is_none());
}

#[test]
fn errors_of_the_system_have_their_kind() {
    let error = Boxed::from(Error::from(io::Error::from(io::ErrorKind::StorageFull)));
    let Some(Error::Io(inner)) = error.downcast_ref() else { panic!("{error}") };
    assert_eq!(inner.kind(), io::ErrorKind::StorageFull);
}

#[test]
fn no_error_repeats_the_words_of_its_source() {
    let of_system = io::Error::from_raw_os_error(28);
    let errors = [Error::from(of_system), Error::from(durer::Error::Cancelled), Error::whole("a")];
    for error in errors {
        let mut said = vec![error.to_string()];
        let mut source = std::error::Error::source(&error);
        while let Some(inner) = source {
            said.push(inner.to_string());
            source = inner.source();
        }
        for (i, words) in said.iter().enumerate() {
            assert!(!said[..i].iter().any(|before| before.contains(words.as_str())), "{said:?}");
        }
    }
}

#[test]
fn errors_of_the_library_keep_their_words() {
    let inner = durer::Error::Cancelled;
    assert_eq!(Error::from(inner.clone()).to_string(), inner.to_string());
}
