//! Errors as programs pass them on.

use durer::Error;
use durer::clip::line::LineClipper;
use durer::math::{DVec2, Rect};

type Boxed = Box<dyn std::error::Error + Send + Sync + 'static>;

fn refused() -> Result<Rect, Boxed> {
    Ok(Rect::new(DVec2::ONE, DVec2::ZERO)?)
}

#[test]
fn errors_go_where_any_error_goes() {
    let error = refused().expect_err("corners in the wrong order");
    assert!(matches!(error.downcast_ref(), Some(Error::Parameter { .. })));
    // The message is complete; no source error repeats a part of it.
    assert!(error.source().is_none());
    let other = std::thread::spawn(move || error.to_string()).join().expect("no panic");
    assert_eq!(other, refused().expect_err("as before").to_string());
    assert!("no-such".parse::<LineClipper>().map_err(Boxed::from).is_err());
}
