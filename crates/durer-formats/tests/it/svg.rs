//! Drawings in SVG: painted parts, warnings, errors.

use durer::math::DAffine2;
use durer::raster::paint::{Canvas, Options};
use durer::target::Pixels;
use durer_formats::svg::{Drawing, ReadOptions};
use durer_formats::{Resources, png};

fn drawing(body: &str) -> Drawing {
    let text = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
        width="20" height="20">{body}</svg>"#
    );
    Drawing::read(text.as_bytes(), &ReadOptions::default()).unwrap()
}

fn paint(drawing: &Drawing) -> (Pixels<[u8; 4]>, Vec<String>) {
    let mut canvas = Canvas::new(20, 20, Options::default()).unwrap();
    let warnings = drawing.draw(&mut canvas, DAffine2::IDENTITY);
    let mut picture = Pixels::new(20, 20, [0; 4]);
    canvas.render(&mut picture).unwrap();
    (picture, warnings.iter().map(ToString::to_string).collect())
}

fn painted(body: &str) -> Pixels<[u8; 4]> {
    let (picture, warnings) = paint(&drawing(body));
    assert!(warnings.is_empty(), "{warnings:?}");
    picture
}

#[test]
fn clip_paths_are_nested_and_united() {
    let picture = painted(
        r#"<clipPath id="a"><rect width="8" height="20"/><rect x="12" width="8" height="20"/></clipPath>
        <clipPath id="b" clip-path="url(#a)"><rect y="10" width="20" height="10"/></clipPath>
        <rect width="20" height="20" fill="red" clip-path="url(#b)"/>"#,
    );
    let red = |x, y| picture.get(x, y) == Some([255, 0, 0, 255]);
    assert!(red(4, 15) && red(15, 15));
    assert!(!red(10, 15) && !red(4, 5) && !red(15, 5));
}

#[test]
fn masks_take_brightness_or_opacity() {
    let mask = |kind: &str| {
        let picture = painted(&format!(
            r#"<mask id="m" mask-type="{kind}" maskUnits="userSpaceOnUse" width="20" height="20">
            <rect width="10" height="20" fill="white"/>
            <rect x="10" width="5" height="20" fill="black"/></mask>
            <g mask="url(#m)"><rect width="20" height="20" fill="red"/></g>"#
        ));
        [5, 12, 17].map(|x| picture.get(x, 10).unwrap()[3])
    };
    assert_eq!(mask("luminance"), [255, 0, 0]);
    assert_eq!(mask("alpha"), [255, 255, 0]);
}

#[test]
fn a_mask_is_not_clipped_by_what_it_is_used_in() {
    // The border of the clip path is within a pixel; applied twice, it would be too thin.
    let picture = painted(
        r#"<clipPath id="c"><rect width="10.5" height="20"/></clipPath>
        <mask id="m" maskUnits="userSpaceOnUse" width="20" height="20">
        <rect width="20" height="20" fill="white"/></mask>
        <g clip-path="url(#c)"><g mask="url(#m)"><rect width="20" height="20"/></g></g>"#,
    );
    assert_eq!(picture.get(10, 10), Some([0, 0, 0, 128]));
}

#[test]
fn groups_are_faded_as_one() {
    let picture = painted(
        r#"<g opacity="0.5"><rect width="12" height="20"/><rect x="8" width="12" height="20"/></g>"#,
    );
    assert!(picture.data().iter().all(|p| *p == [0, 0, 0, 128]));
}

#[test]
fn patterns_are_repeated() {
    let picture = painted(
        r#"<pattern id="p" width="4" height="4" patternUnits="userSpaceOnUse">
        <rect width="2" height="4" fill="lime"/></pattern>
        <rect width="20" height="20" fill="url(#p)"/>"#,
    );
    for x in 0..20 {
        let lime = x % 4 < 2;
        assert_eq!(picture.get(x, 7).unwrap()[3] == 255, lime, "column {x}");
    }
}

/// Gives the same picture for any name but one.
struct OnePicture(Vec<u8>);

impl Resources for OnePicture {
    fn read(&self, path: &str, _limit: u64) -> Result<Vec<u8>, String> {
        if path == "none.png" {
            Err("there is no such file".to_owned())
        } else {
            Ok(self.0.clone())
        }
    }
}

#[test]
fn images_fill_their_frame_and_missing_ones_are_reported() {
    let mut bytes = Vec::new();
    let image = Pixels::from_data(2, 1, vec![[255, 0, 0, 255], [0, 0, 255, 255]]).unwrap();
    png::write_color(&mut bytes, &image, png::Compression::Fast).unwrap();
    let resources = OnePicture(bytes);
    let options = ReadOptions { resources: &resources, ..ReadOptions::default() };
    let text = br#"<svg xmlns="http://www.w3.org/2000/svg" width="20" height="20">
        <image href="a.png" width="20" height="20" preserveAspectRatio="none"/>
        <image href="none.png" width="20" height="20"/></svg>"#;
    let drawing = Drawing::read(text, &options).unwrap();
    let messages = drawing.warnings()[0].to_string();
    assert_eq!(messages, "line 3, column 16: image `none.png` is left out: there is no such file");
    let (picture, _) = paint(&drawing);
    assert_eq!(picture.get(0, 0), Some([255, 0, 0, 255]), "no fading at the border");
    assert_eq!(picture.get(19, 19), Some([0, 0, 255, 255]));
}

#[test]
fn text_without_fonts_is_reported() {
    let messages = drawing("<text y='10'>A</text>").warnings()[0].to_string();
    assert_eq!(messages, "text is left out: there are no fonts");
}

#[test]
fn what_is_no_drawing_is_refused_with_its_place() {
    let error = |text: &[u8]| Drawing::read(text, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error(b"<svg\n  <rect/>").starts_with("line 2, column 3: not well-formed XML: "));
    assert!(
        error(b"<svg xmlns='http://www.w3.org/2000/svg' width='0' height='5'/>").contains("size")
    );
    assert!(error(b"<html/>").contains("the root is `html`, not `svg`"));
    assert!(error(b"\xff\xff").contains("UTF-8"));
}

#[test]
fn arcs_from_far_away_are_refused_at_once() {
    let document = |d: &str| {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>\n<path d='{d}'/></svg>"
        );
        Drawing::read(text.as_bytes(), &ReadOptions::default())
    };
    for path in [
        "M1 1S80 20 3.4e38 70A10 20 30 0 1 5 5Z",
        "M1 1a1e38 1 0 1 1 3 3",
        "M-9e37 0v3a1 1 0 0 0 1 1",
    ] {
        let error = document(path).unwrap_err().to_string();
        assert!(error.starts_with("line 2") && error.contains("arcs"), "{error}");
    }
    // Without arcs the length does not matter, and arcs of any useful size are drawn.
    document("M1 1L3.4e38 70L5 5Z").expect("a drawing");
    document("M1 1L1e15 70A10 20 30 0 1 5 5Z").expect("a drawing");
}

#[test]
fn what_is_nested_deeply_is_left_out() {
    let body = format!(
        "{}<rect width='20' height='20'/>{}",
        "<g opacity='.9'>".repeat(300),
        "</g>".repeat(300)
    );
    let (_, warnings) = paint(&drawing(&body));
    assert!(warnings[0].contains("200 levels deep"), "{warnings:?}");
}

fn messages(body: &str) -> Vec<String> {
    drawing(body).warnings().iter().map(ToString::to_string).collect()
}

#[test]
fn values_that_cannot_be_used_are_reported_with_their_place() {
    for (body, name, part) in [
        (
            "<rect width='9' height='9'\n stroke='blakc'/>",
            "line 3, column 2: `stroke` of `rect`",
            "a colour",
        ),
        ("<g\nopacity='half'/>", "line 3, column 1: `opacity` of `g`", "0 to 1"),
        ("<rect width='abc' height='3'/>", "`width` of `rect` is `abc`", "a length of at least 0"),
        ("<rect width='3furlongs' height='3'/>", "is `3furlongs`", "is ignored"),
        (
            "<rect width='-3' height='3'/>",
            "is `-3`",
            "at least 0, as `12`, `3.5mm` or `20%`; it counts as 0",
        ),
        ("<path d='M0 0L5 5X'/>", "`d` of `path`", "the part before the error is drawn"),
        ("<polygon points='1 1 2 3 4'/>", "`points` of `polygon`", "pairs of numbers"),
        ("<g transform='turn(5)'/>", "`transform` of `g`", "`rotate`"),
        ("<g transform='scale(1e-7)'/>", "`transform` of `g`", "are left out"),
        ("<g stroke-linecap='flat'/>", "`stroke-linecap`", "one of butt, round, square"),
        ("<g style='fill:reddd;x:y'/>", "`fill` of `g` is `reddd`", "a colour"),
        ("<style>g{stroke-width:-2}</style>", "`stroke-width` of `style`", "at least 0"),
    ] {
        let found = messages(body);
        assert_eq!(found.len(), 1, "{body}: {found:?}");
        assert!(found[0].contains(name) && found[0].contains(part), "{body}: {found:?}");
        assert!(found[0].starts_with("line "), "{found:?}");
    }
    // A repeated value gives one warning.
    assert_eq!(messages("<g fill='x'/><g fill='x'/><g stroke='x'/>").len(), 2);
}

#[test]
fn values_that_mean_something_are_not_reported() {
    let body = "<g fill='NONE' stroke=' red ' stroke-width=' 2PX ' color='#123' transform=''/>
        <g fill='currentcolor' stroke='inherit' opacity='50%' stroke-dasharray='none' d='x'/>
        <rect x='1%' y='2em' width='auto' height='3mm' rx='auto'/><path d=''/><path d='none'/>
        <g fill='url(#a) none' stroke-dasharray='1,2 3' style='transform:none;cursor:help'/>";
    assert_eq!(messages(body), Vec::<String>::new());
    assert_eq!(
        messages("<rect><animate fill='freeze' width='x'/></rect>").len(),
        1,
        "of the animation"
    );
}

#[test]
fn what_cannot_be_used_counts_as_not_given() {
    let pixel = |body: &str| paint(&drawing(body)).0.get(10, 10);
    let lime = Some([0, 255, 0, 255]);
    let rect = "<rect width='20' height='20'";
    assert_eq!(pixel(&format!("<g fill='lime'>{rect} fill='blakc'/></g>")), lime);
    assert_eq!(pixel(&format!("<g fill='lime'>{rect} fill=''/></g>")), lime);
    assert_eq!(pixel(&format!("{rect} fill=' Lime '/>")), lime);
    assert_eq!(pixel(&format!("<g color='lime'>{rect} fill='currentcolor'/></g>")), lime);
}

#[test]
fn rebeccapurple_is_a_color() {
    for body in [
        "<rect width='20' height='20' fill='RebeccaPurple'/>",
        "<rect width='20' height='20' style='stroke:none;fill: rebeccapurple'/>",
        "<style>rect{fill:rebeccapurple}</style><rect width='20' height='20'/>",
    ] {
        assert_eq!(painted(body).get(10, 10), Some([0x66, 0x33, 0x99, 255]), "{body}");
        assert_eq!(messages(body), Vec::<String>::new());
    }
}

/// Checks circular references: if they were not cut, following them would overflow the stack.
#[test]
fn references_in_a_circle_are_refused() {
    let pattern = |id: &str, more: &str, inside: &str| {
        format!(
            "<pattern id='{id}' {more} width='9' height='9' patternUnits='userSpaceOnUse'>{inside}</pattern>"
        )
    };
    let shape = |more: &str| format!("<path d='M0 0h9v9z' {more}/>");
    let filled = |id: &str| shape(&format!("fill='url(#{id})'"));
    let ring = |names: &[&str], element: &str, property: &str| {
        let next = names.iter().cycle().skip(1);
        let parts = names.iter().zip(next).map(|(id, next)| {
            let inside = shape(&format!("{property}='url(#{next})'"));
            match element {
                "pattern" => pattern(id, "", &inside),
                _ => format!("<{element} id='{id}'>{inside}</{element}>"),
            }
        });
        parts.collect::<String>() + &shape(&format!("{property}='url(#{})'", names[0]))
    };
    let texts = |element: &str| {
        let name = element.split(' ').next().unwrap_or_default();
        let parts = ["ab", "bc", "ca"].map(|ids| {
            let fill = format!("fill='url(#{})'", &ids[1..]);
            pattern(&ids[..1], "", &format!("<text><{element} {fill}>x</{name}></text>"))
        });
        parts.concat() + &filled("a")
    };
    let mask =
        |id: &str, more: &str, inside: &str| format!("<mask id='{id}' {more}>{inside}</mask>");
    let named = |name: &str, more: &str| {
        let parts = ["ab", "bc", "ca"].map(|ids| {
            pattern(&ids[..1], "", &shape(&format!("{name}='url(#{})' {more}", &ids[1..])))
        });
        parts.concat() + &filled("a")
    };
    let linked = |href: &str| {
        let parts = ["ab", "bc", "ca"].map(|ids| {
            let shown = shape(&format!("mask='url(#{})'", &ids[1..]));
            let id = &ids[..1];
            mask(id, "", &format!("<use {href}='#k{id}'/>")) + &format!("<g id='k{id}'>{shown}</g>")
        });
        parts.concat() + &shape("id='r'")
    };
    let important = |ids: &str| {
        let (id, next) = ids.split_at(1);
        let inside = pattern(id, "", &shape("style='fill:inherit;fill:none'"));
        format!("<g style='fill:url(#{next})!important'>{inside}</g>")
    };
    let filter =
        |id: &str, shown: &str| format!("<filter id='{id}'><feImage href='#{shown}'/></filter>");
    let read = |body: &str| {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
             xmlns:other='urn:other' width='20' height='20'>\n{body}</svg>"
        );
        Drawing::read(text.as_bytes(), &ReadOptions::default()).map_err(|e| e.to_string())
    };
    for body in [
        ring(&["a", "b", "c"], "pattern", "fill"),
        ring(&["a", "b", "c", "d"], "pattern", "stroke"),
        ring(&["a", "b", "c"], "mask", "mask"),
        ring(&["a", "b", "c"], "clipPath", "clip-path"),
        pattern("a", "href='#b'", "") + &pattern("b", "", &filled("a")) + &filled("a"),
        format!("<g fill='url(#a)'>{}{}</g>", pattern("a", "", &shape("")), shape("")),
        // Of several elements with one id usvg takes the last.
        format!("<g id='a'/><g fill='url(#a)'>{}</g>", pattern("a", "", &shape("")) + &shape("")),
        pattern("a", "", "<use href='#r' fill='url(#b)'/>")
            + &pattern("b", "", "<use href='#r' fill='url(#c)'/>")
            + &pattern("c", "", "<use href='#r' fill='url(#a)'/>")
            + &shape("id='r'")
            + &filled("a"),
        pattern("a", "fill='url(#b)'", &shape("fill='blakc'"))
            + &pattern("b", "fill='url(#c)'", &shape("fill='blakc'"))
            + &pattern("c", "fill='url(#a)'", &shape("fill='blakc'"))
            + &filled("a"),
        pattern("a", "", &shape("mask='url(#m)'"))
            + &format!("<mask id='m'>{}</mask>", filled("a"))
            + &filled("a"),
        format!(
            "<style>.a{{fill:url(#a)}} path.b{{fill:url(#b)}} .c{{fill:url(#c) !important}}</style>{}{}{}{}",
            pattern("a", "", &shape("class='b'")),
            pattern("b", "", &shape("class='c' style='fill:red'")),
            pattern("c", "", &shape("class='a'")),
            shape("class='a'")
        ),
        pattern("a", "", &shape("style='fill: url( \"#b\" )'"))
            + &pattern("b", "", &shape("stroke='url(#a)'"))
            + &filled("b"),
        // The painted shape does not matter.
        pattern("a", "", "<use href='#r' fill='url(#b)'/>")
            + &pattern("b", "", "<use href='#r' fill='url(#c)'/>")
            + &pattern("c", "", "<use href='#r' fill='url(#a)'/>")
            + &shape("id='r' fill='red'")
            + &filled("a"),
        texts("textPath href='#r'") + &shape("id='r'"),
        texts("a"),
        texts("tref href='#r'") + "<text id='r'>x</text>",
        // Each pattern refers to the other once by fill and once by stroke, which is found last.
        pattern("a", "", &filled("b"))
            + &pattern("b", "", &(shape("stroke='url(#a)'") + &filled("a")))
            + &filled("b"),
        // An inherited paint is not seen where circles are cut, nor is the first of two.
        format!(
            "{}<g fill='url(#a)'>{}</g>{}",
            pattern("a", "", &filled("b")),
            pattern("b", "", &shape("")),
            filled("b")
        ),
        // Other attributes of the same name, first or last.
        named("other:fill='none' fill", ""),
        linked("xlink:href='#r' href"),
        linked("other:href='#r' href"),
        ring(&["a", "b", "c"], "pattern", "fill").replace(" id=", " other:id='z' id="),
        // Inherited.
        format!(
            "<g mask='url(#b)'>{}</g><g mask='url(#c)'>{}</g><g mask='url(#a)'>{}</g>",
            mask("a", "mask='inherit'", &shape("")),
            mask("b", "mask='inherit'", &shape("")),
            mask("c", "mask='inherit'", &shape(""))
        ),
        // Filters, through their images.
        filter("f", "g") + &format!("<g id='g'>{}</g>", shape("filter='url(#f)'")),
        filter("f", "s")
            + &filter("g", "r")
            + &shape("id='r' filter='blur(1) url(#f)'")
            + &shape("id='s' filter='url(#g)'"),
    ] {
        let messages = read(&body).expect_err(&body);
        assert!(
            messages.starts_with("line 2, column") && messages.contains("go in a circle"),
            "{messages}"
        );
    }
    // These are cut.
    for body in [
        ring(&["a"], "pattern", "fill"),
        ring(&["a", "b"], "pattern", "fill"),
        ring(&["a", "b"], "mask", "mask"),
        ring(&["a", "b", "c"], "marker", "marker-start"),
        format!("<g fill='url(#a)'>{}{}</g>", pattern("a", "", &shape("fill='red'")), shape("")),
        ring(&["a", "b", "c"], "pattern", "fill") + "<style>path{fill:red}</style>",
        pattern("a", "", "<use href='#r' fill='red'/>")
            + &format!("<g fill='url(#a)'>{}</g>", shape("id='r'")),
        filter("f", "r") + &shape("id='r' filter='url(#f)'"),
        pattern("a", "", &format!("<a href='#r'>{}</a>", shape("")))
            + &format!("<g id='r'>{}</g>", filled("a")),
        ring(&["a", "b", "c"], "pattern", "other:fill"),
        // `!important` on an ancestor has no effect here.
        ["ab", "bc", "ca"].map(important).concat(),
        // Among important declarations the element's own style wins.
        format!(
            "<style>.a{{fill:url(#a)!important}} .b{{fill:url(#b)!important}} .c{{fill:url(#c)!important}}</style>{}",
            ["ab", "bc", "ca"]
                .map(|ids| {
                    let style = format!("class='{}' style='fill:none!important'", &ids[1..]);
                    pattern(&ids[..1], "", &shape(&style))
                })
                .concat()
        ),
        // It is not the same as `fill`.
        named("xlink:fill", "fill='none'"),
    ] {
        assert!(read(&body).is_ok(), "{body}");
    }
}

#[test]
fn an_arc_to_where_it_begins_draws_nothing() {
    let once = "M2 3A14 1.7 40 1 1 12.3 14.1";
    let path = |d: &str| painted(&format!("<path fill='none' stroke='red' d='{d}'/>"));
    assert_eq!(path(once), path(&format!("{once}A5 3 159 1 1 12.3 14.1")));
}

#[test]
fn references_that_are_deep_are_refused() {
    let chain = |count: usize| {
        let patterns: String = (0..count)
            .map(|i| {
                let fill = format!("fill='url(#a{})'", i + 1);
                format!(
                    "<pattern id='a{i}' width='9' height='9'><path d='M0 0h9v9z' {fill}/></pattern>"
                )
            })
            .collect();
        format!("{patterns}<path d='M0 0h9v9z' fill='url(#a0)'/>")
    };
    let words = |count: usize| {
        format!("<text>{}a{}</text>", "<tspan>".repeat(count), "</tspan>".repeat(count))
    };
    for body in [chain(20_000), words(20_000)] {
        let text =
            format!("<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>{body}</svg>");
        let messages =
            Drawing::read(text.as_bytes(), &ReadOptions::default()).expect_err("too deep");
        assert!(messages.to_string().contains("more than 1024 levels deep"), "{messages}");
    }
    drawing(&chain(50));
    drawing(&words(50));
}

#[test]
fn references_that_multiply_are_refused() {
    let doubling = |count: usize, element: &str, property: &str| {
        let parts: String = (0..count)
            .map(|i| {
                let shape = format!("<path d='M0 0h9v9z' {property}='url(#a{})'/>", i + 1);
                format!("<{element} id='a{i}' width='9' height='9'>{shape}{shape}</{element}>")
            })
            .collect();
        format!("{parts}<path d='M0 0h9v9z' {property}='url(#a0)'/>")
    };
    for (element, property) in [("pattern", "fill"), ("mask", "mask"), ("clipPath", "clip-path")] {
        let body = doubling(40, element, property);
        let text =
            format!("<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>{body}</svg>");
        let messages =
            Drawing::read(text.as_bytes(), &ReadOptions::default()).expect_err("too many");
        assert!(messages.to_string().contains("followed more than 1000000 times"), "{messages}");
        drawing(&doubling(6, element, property));
    }
}

/// A drawing that makes usvg panic.
#[test]
fn coordinates_that_overflow_are_refused() {
    let strokes = "<g transform='scale(-2 1)'><g transform='scale(1e20)'><g transform='rotate(30)'>
        <path d='M1 1L9 9h-5v-3q2 2 3 0t1 1s2 2 3 3A5 3 20 1 0 9 9' stroke='lime'/></g></g></g>";
    let text = |body: &str| {
        format!("<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>{body}</svg>")
    };
    let read = |body: &str| Drawing::read(text(body).as_bytes(), &ReadOptions::default());
    let why = read(strokes).expect_err("an overflow").to_string();
    assert!(why.contains("coordinates must stay within"), "{why}");
    assert!(read(&strokes.replace("1e20", "1e10")).is_ok());
}

/// Checks that drawings embedded as images are examined like the drawing itself.
#[test]
fn images_that_are_drawings_cannot_fill_the_stack() {
    let image = |body: &str| {
        let text =
            format!("<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>{body}</svg>");
        let text = text.replace('%', "%25").replace('#', "%23").replace('&', "&amp;");
        let text = text.replace('<', "&lt;").replace('"', "&quot;");
        format!("<image width='9' height='9' href=\"data:image/svg+xml,{text}\"/>")
    };
    let groups = |count: usize, inside: &str| {
        format!("{}{inside}{}", "<g opacity='.5'>".repeat(count), "</g>".repeat(count))
    };
    let rect = "<rect width='20' height='20' fill='lime'/>";
    let circle = ["ab", "bc", "ca"].map(|ids| {
        let (id, next) = ids.split_at(1);
        format!("<mask id='{id}'><g mask='url(#{next})'>{rect}</g></mask>")
    });
    for (body, expected) in [
        (circle.concat(), "go in a circle"),
        (groups(2000, rect), "more than 1024 levels deep"),
        (image(&circle.concat()), "go in a circle"),
        ("<path d='M0 0A1e30 1e30 0 0 0 1e30 1'/>".to_owned(), "farther than arcs can be drawn"),
    ] {
        let messages = messages(&image(&body));
        let messages =
            messages.iter().find(|messages| messages.contains(expected)).expect("a warning");
        assert!(messages.contains("is left out: it is a drawing: line 1, column"), "{messages}");
    }
    // None is too deep by itself.
    let deep = messages(&groups(700, &image(&groups(700, rect))));
    assert!(deep[0].contains("more than 1024 levels deep"), "{deep:?}");
    let many = image(&image(rect));
    assert_eq!(messages(&many), Vec::<String>::new());
    assert_eq!(painted(&many).get(4, 4), Some([0, 255, 0, 255]));
}
