//! Drawings in SVG with style sheets, or with values newer than SVG 1.1: painted as browsers do.

use durer::math::DAffine2;
use durer::raster::paint::{Canvas, Options};
use durer::target::Pixels;
use durer_formats::svg::{Drawing, Fonts, ReadOptions};

/// Returns a drawing of 40 × 40 with its warnings, from reading and from drawing.
fn draw_with(bytes: &[u8], fonts: &Fonts) -> (Pixels<[u8; 4]>, Vec<String>) {
    let options = ReadOptions { fonts, ..ReadOptions::default() };
    let drawing = Drawing::read(bytes, &options).unwrap();
    let mut canvas = Canvas::new(40, 40, Options::default()).unwrap();
    let messages = drawing.draw(&mut canvas, DAffine2::IDENTITY);
    let mut picture = Pixels::new(40, 40, [0; 4]);
    canvas.render(&mut picture).unwrap();
    (picture, drawing.warnings().iter().chain(&messages).map(ToString::to_string).collect())
}

fn document(body: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' width='40' height='40'>{body}</svg>"
    )
}

fn draw(body: &str) -> (Pixels<[u8; 4]>, Vec<String>) {
    draw_with(document(body).as_bytes(), &Fonts::new())
}

/// Returns a picture that is drawn without a warning.
fn painted(body: &str) -> Pixels<[u8; 4]> {
    let (picture, messages) = draw(body);
    assert_eq!(messages, Vec::<String>::new(), "{body}");
    picture
}

/// Returns the box around all pixels that are more than half opaque: left, top, right, bottom.
fn extent(picture: &Pixels<[u8; 4]>) -> Option<[u32; 4]> {
    let pixels = (0..40).flat_map(|y| (0..40).map(move |x| (x, y)));
    let seen = pixels.filter(|(x, y)| picture.get(*x, *y).is_some_and(|p| p[3] > 127));
    seen.fold(None, |found: Option<[u32; 4]>, (x, y)| {
        let [l, t, r, b] = found.unwrap_or([x, y, x, y]);
        Some([l.min(x), t.min(y), r.max(x), b.max(y)])
    })
    .map(|[l, t, r, b]| [l, t, r + 1, b + 1])
}

const LIME: [u8; 4] = [0, 255, 0, 255];
const RECT: &str = "width='40' height='40'";

#[test]
fn rules_count_as_in_browsers() {
    for body in [
        // Custom properties do not invalidate their rule.
        format!("<style>.x{{--c:red;fill:lime}}</style><rect class='x' {RECT}/>"),
        format!("<style>rect{{fill:red}} .a{{fill:lime}}</style><rect class='a' {RECT}/>"),
        format!("<style>.a{{fill:lime}} rect{{fill:red}}</style><rect class='a' {RECT}/>"),
        format!("<style>#i{{fill:lime}} .a.b{{fill:red}}</style><rect id='i' class='a b' {RECT}/>"),
        format!("<style>rect{{fill:lime!important}}</style><rect style='fill:red' {RECT}/>"),
        format!(
            "<style>rect{{fill:red!important}}</style><rect style='fill:lime!important' {RECT}/>"
        ),
        format!("<style>*{{fill:lime}}</style><rect fill='red' {RECT}/>"),
        format!("<style>rect{{fill:lime;fill:nonsense}}</style><rect {RECT}/>")
            .replace("nonsense", "lime"),
        format!("<style>rect:nth-child(3){{fill:lime}}</style><g/><rect {RECT}/>"),
        format!("<style>rect:not(.b){{fill:lime}}</style><rect class='a' {RECT}/>"),
        format!("<style>:is(g, a) > rect:last-of-type{{fill:lime}}</style><g><rect {RECT}/></g>"),
        format!(
            "<style>@media screen{{rect{{fill:lime}}}} @media print{{rect{{fill:red}}}}</style><rect {RECT}/>"
        ),
        format!("<style>@media (max-width:50px){{rect{{fill:lime}}}}</style><rect {RECT}/>"),
        format!("<style media='print'>rect{{fill:red}}</style><rect fill='lime' {RECT}/>"),
        format!("<style type='text/css'><![CDATA[rect{{fill:lime}}]]></style><rect {RECT}/>"),
        format!("<style>rect:hover{{fill:red}}</style><rect fill='lime' {RECT}/>"),
        format!("<g fill='lime'><rect style='fill:inherit' fill='red' {RECT}/></g>"),
        format!("<g fill='lime'><rect style='fill:unset' fill='red' {RECT}/></g>"),
        format!(
            "<style>rect{{fill:lime}} .x{{cursor:pointer;user-select:none}}</style><rect class='x' {RECT}/>"
        ),
        format!("<style>g &gt; rect{{fill:lime}}</style><g><rect {RECT}/></g>"),
    ] {
        assert_eq!(painted(&body).get(20, 20), Some(LIME), "{body}");
    }
    let black = format!("<g fill='red'><rect style='fill:initial' {RECT}/></g>");
    assert_eq!(painted(&black).get(20, 20), Some([0, 0, 0, 255]));
}

#[test]
fn variables_stand_for_their_values() {
    for body in [
        format!("<style>:root{{--c:lime}} rect{{fill:var(--c)}}</style><rect {RECT}/>"),
        format!("<g style='--c:red'><g style='--c:lime'><rect fill='var(--c)' {RECT}/></g></g>"),
        format!("<rect style='fill:var(--none, var(--neither, lime))' {RECT}/>"),
        format!(
            "<g style='--r:0;--g:255'><rect style='fill:rgb(var(--r) var(--g) 0)' {RECT}/></g>"
        ),
        "<rect fill='lime' style='--w:20px;width:calc(var(--w) * 2);height:40px'/>".to_owned(),
        // The content of `use` inherits from the `use`.
        format!(
            "<defs><rect id='r' style='fill:var(--c, red)' {RECT}/></defs><g style='--c:lime'><use href='#r'/></g>"
        ),
    ] {
        assert_eq!(painted(&body).get(20, 20), Some(LIME), "{body}");
    }
    let (picture, messages) = draw(&format!(
        "<g fill='lime'>\n<rect style='--a:var(--b);--b:var(--a);fill:var(--a)' {RECT}/></g>"
    ));
    assert_eq!(picture.get(20, 20), Some(LIME), "as if nothing were said");
    assert!(
        messages[0].starts_with("line 2, column 7: `fill` of `rect`")
            && messages[0].contains("is undefined"),
        "{messages:?}"
    );
}

#[test]
fn modern_colors_are_painted() {
    for (color, expected) in [
        ("rgb(10% 50% 90% / 100%)", [26, 128, 230, 255]),
        ("oklch(51.975% 0.17686 142.495)", [0, 128, 0, 255]),
        ("color-mix(in srgb, red, blue)", [128, 0, 128, 255]),
        ("hwb(120 0% 0%)", LIME),
        ("light-dark(lime, red)", LIME),
        ("#0f08", [0, 255, 0, 136]),
    ] {
        for body in [
            format!("<rect fill='{color}' {RECT}/>"),
            format!("<style>rect{{fill:{color}}}</style><rect {RECT}/>"),
            format!("<g color='{color}'><rect fill='currentColor' {RECT}/></g>"),
            format!(
                "<linearGradient id='g'><stop stop-color='{color}'/></linearGradient><rect fill='url(#g)' {RECT}/>"
            ),
            format!("<rect fill='url(#none) {color}' {RECT}/>"),
        ] {
            assert_eq!(painted(&body).get(20, 20), Some(expected), "{body}");
        }
    }
    let mixed =
        format!("<g color='blue'><rect fill='color-mix(in srgb, currentColor, red)' {RECT}/></g>");
    assert_eq!(painted(&mixed).get(20, 20), Some([128, 0, 128, 255]));
}

#[test]
fn geometry_may_be_said_in_css() {
    for (body, expected) in [
        (
            "<style>rect{x:5px;y:10px;width:20px;height:calc(100% - 20px)}</style><rect/>",
            [5, 10, 25, 30],
        ),
        ("<rect style='x:5;width:25%;height:1em' y='2'/>", [5, 2, 15, 18]),
        ("<style>circle{cx:20px;cy:50%;r:.625rem}</style><circle r='3'/>", [10, 10, 30, 30]),
        ("<style>path{d:path(\"M5 5H15V20H5z\")}</style><path d='M0 0h1v1z'/>", [5, 5, 15, 20]),
        ("<rect width='calc(10px + 5px)' height='10'/>", [0, 0, 15, 10]),
        (
            "<rect width='5' height='5' style='width:auto'/><rect x='3' width='4' height='4'/>",
            [3, 0, 7, 4],
        ),
    ] {
        assert_eq!(extent(&painted(body)), Some(expected), "{body}");
    }
    let (picture, messages) = draw("<style>rect{width:10}</style><rect width='30' height='30'/>");
    assert_eq!(
        extent(&picture),
        Some([0, 0, 30, 30]),
        "lengths without units are none in style sheets"
    );
    assert!(messages[0].contains("needs a unit"), "{messages:?}");
}

#[test]
fn transforms_may_be_said_in_css() {
    for (style, expected) in [
        ("transform:translate(10px,1em)", [10, 16, 20, 26]),
        ("transform:translate(50%,0)", [20, 0, 30, 10]),
        ("transform:scale(200%)", [0, 0, 20, 20]),
        ("transform:rotate(90deg);transform-origin:10px 10px", [10, 0, 20, 10]),
        ("transform:rotate(.25turn);transform-origin:50% 50%", [30, 0, 40, 10]),
        ("transform:translate(100%,100%);transform-box:fill-box", [10, 10, 20, 20]),
        ("transform:scale(3);transform-box:fill-box;transform-origin:right bottom", [0, 0, 10, 10]),
        ("translate:5px 6px;scale:2", [5, 6, 25, 26]),
        ("rotate:-180deg;transform-origin:20px 20px", [30, 30, 40, 40]),
        ("transform:none", [0, 0, 10, 10]),
        ("transform:matrix(1,0,0,1,3,4)", [3, 4, 13, 14]),
    ] {
        let body = format!("<rect width='10' height='10' style='{style}'/>");
        assert_eq!(extent(&painted(&body)), Some(expected), "{style}");
    }
    let group = "<g style='transform:scale(2);transform-box:fill-box;transform-origin:center'><rect x='15' y='15' width='4' height='4'/>
        <g transform='translate(15 15)'><rect x='6' y='6' width='4' height='4'/></g></g>";
    assert_eq!(extent(&painted(group)), Some([10, 10, 30, 30]));
    let (_, messages) = draw("<rect width='1' height='1'\nstyle='transform:rotateX(3deg)'/>");
    assert!(
        messages[0].starts_with("line 2, column 1: `transform` of `rect` is `rotateX(3deg)`"),
        "{messages:?}"
    );
}

#[test]
fn shapes_clip() {
    let rect = |clip: &str, more: &str| {
        format!("<rect x='10' y='10' width='20' height='20' style='clip-path:{clip}' {more}/>")
    };
    for (clip, expected) in [
        ("inset(25% 5px)", [15, 15, 25, 25]),
        ("circle(5px)", [15, 15, 25, 25]),
        ("circle(5px at 0 0)", [10, 10, 15, 15]),
        ("ellipse(5px 10px)", [15, 10, 25, 30]),
        ("polygon(0 0, 50% 0, 50% 50%, 0 50%)", [10, 10, 20, 20]),
        ("path(\"M0 0h5v5h-5z\")", [10, 10, 15, 15]),
        ("inset(15px) view-box", [15, 15, 25, 25]),
        ("none", [10, 10, 30, 30]),
    ] {
        assert_eq!(extent(&painted(&rect(clip, ""))), Some(expected), "{clip}");
    }
    // Without a box, the width that the stroke adds counts.
    let stroked = rect("inset(4px)", "stroke='red' stroke-width='8'");
    assert_eq!(extent(&painted(&stroked)), Some([10, 10, 30, 30]));
    let of_attribute =
        "<g clip-path='circle(25% at 50% 50%) view-box'><rect width='40' height='40'/></g>";
    assert_eq!(extent(&painted(of_attribute)), Some([10, 10, 30, 30]));
    let (picture, messages) = draw(&rect("blob(3px)", ""));
    assert_eq!(extent(&picture), Some([10, 10, 30, 30]));
    assert!(messages[0].contains("`clip-path` of `rect` is `blob(3px)`"), "{messages:?}");
}

#[test]
fn dashes_are_measured_in_the_length_that_is_said() {
    // Of four dashes the first and the third are painted.
    let picture = painted(
        "<path pathLength='4' d='M0 20H40' stroke='lime' stroke-width='4' stroke-dasharray='1'/>",
    );
    assert_eq!([5, 15, 25, 35].map(|x| picture.get(x, 20).unwrap()[3]), [255, 0, 255, 0]);
    let picture = painted(
        "<g stroke-dasharray='1' stroke-dashoffset='1'><circle pathLength='4' cx='20' cy='20' r='16' fill='none' stroke='lime' stroke-width='4'/></g>",
    );
    let at = [(31, 31), (9, 31), (9, 9), (31, 9)].map(|(x, y)| picture.get(x, y).unwrap()[3] > 127);
    assert_eq!(at, [false, true, false, true]);
}

#[test]
fn what_is_not_understood_is_reported_with_its_line() {
    for (body, expected) in [
        ("<style>\n@import url(a.css);</style>", "line 2, column 1: `@import` is ignored"),
        (
            "<style>\n\n rect:has(g){fill:red}</style>",
            "line 3, column 2: the rule for `rect:has(g)` is ignored",
        ),
        ("<style>rect{fill:blakc}</style>", "`fill` of `style` is `blakc`: it must be a colour"),
        (
            "<style>rect{vector-effect:non-scaling-stroke}</style>",
            "`vector-effect: non-scaling-stroke` is not drawn",
        ),
        ("<g style='text-shadow:1px 1px red'/>", "`text-shadow: 1px 1px red` is not drawn"),
        ("<style>@font-face{src:url(x)}</style>", "`@font-face` is ignored"),
        ("<style>a{b{fill:red}}</style>", "the rule for `b` within another rule is ignored"),
        ("<style>rect{fill red}</style>", "`fill red` is not a declaration"),
        (
            "<style>@media (hovering){a{}}</style>",
            "`@media` is ignored: `(hovering)` is not understood",
        ),
        (
            "<rect fill='url(#x)'/>",
            "`fill` of `rect` is `url(#x)`: there is no element with the id `x`",
        ),
        ("<use href='#x'/>", "`href` of `use` is `#x`: there is no element"),
        (
            "<use href='x.svg#x'/>",
            "elements of other files, and pictures, are not read; nothing is drawn",
        ),
        ("<rect fill='url(x.png)'/>", "and pictures, are not read; nothing is painted"),
        ("<rect vector-effect='non-scaling-stroke'/>", "strokes are scaled"),
        ("<g font-variant='small-caps'/>", "`font-variant: small-caps` is not drawn"),
        (
            "<g text-decoration='underline wavy'/>",
            "`text-decoration: underline wavy` is drawn as plain lines",
        ),
        ("<g style='mask:linear-gradient(red,blue)'/>", "only masks that are elements are drawn"),
    ] {
        let (_, messages) = draw(body);
        assert_eq!(messages.len(), 1, "{body}: {messages:?}");
        assert!(
            messages[0].starts_with("line ") && messages[0].contains(expected),
            "{body}: {messages:?}"
        );
    }
}

#[test]
fn symbols_have_the_size_that_they_say() {
    let symbol = "<symbol id='s' viewBox='0 0 4 4' width='20' height='20'><rect width='4' height='4'/></symbol>";
    for (used, expected) in [
        ("<use href='#s' x='5' y='5'/>", [5, 5, 25, 25]),
        ("<use href='#s' width='10' height='10'/>", [0, 0, 10, 10]),
        ("<use xlink:href='#s'/>", [0, 0, 20, 20]),
    ] {
        assert_eq!(extent(&painted(&format!("{symbol}{used}"))), Some(expected), "{used}");
    }
}

#[test]
fn filters_that_are_missing_or_hide_their_element() {
    let rect = |filter: &str| format!("<rect {RECT} fill='lime' filter='{filter}'/>");
    let (picture, messages) = draw(&rect("url(#none)"));
    assert_eq!(picture.get(20, 20), Some(LIME));
    assert!(
        messages.len() == 1 && messages[0].contains("there is no filter with the id `none`"),
        "{messages:?}"
    );
    let shadow = "<filter id='s'><feOffset in='SourceAlpha'/></filter>";
    let (picture, messages) = draw(&format!("{shadow}{}", rect("url(#s)")));
    assert_eq!(picture.get(20, 20), Some([0; 4]), "no shadow is better than a black rectangle");
    assert!(messages.len() == 1 && messages[0].contains("is left out"), "{messages:?}");
}

fn fonts() -> Fonts {
    let mut fonts = Fonts::new();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../durer-cli/fonts/DejaVuSans.ttf");
    assert_eq!(fonts.add(std::fs::read(path).unwrap()), 1);
    fonts
}

#[test]
fn spaced_letters_are_not_joined() {
    let fonts = fonts();
    // In this font `fi` is one glyph.
    let draw = |more: &str| {
        draw_with(
            document(&format!("<text y='30' font-size='20' {more}>fi</text>")).as_bytes(),
            &fonts,
        )
    };
    let right = |more: &str| extent(&draw(more).0).unwrap()[2];
    let joined = right("");
    for more in ["letter-spacing='10'", "style='letter-spacing:.5em'"] {
        let (picture, messages) = draw(more);
        assert_eq!(messages, Vec::<String>::new());
        let empty =
            (0..right(more)).filter(|x| (0..40).all(|y| picture.get(*x, y) == Some([0; 4])));
        assert!(empty.count() > 8, "{more}: there is room between the letters");
        let more_room = right(more) - joined;
        assert!((9..13).contains(&more_room), "{more}: {more_room}");
    }
    assert!(right("letter-spacing='normal'") == joined && right("letter-spacing='0'") == joined);
}

#[test]
fn letters_that_no_font_has_are_reported() {
    let (_, messages) = draw_with(document("<text y='30'>\u{4f60}</text>").as_bytes(), &fonts());
    assert!(
        messages.len() == 1 && messages[0].contains("there is no glyph for \u{4f60} (U+4F60)"),
        "{messages:?}"
    );
}

#[test]
fn text_is_set_in_the_letters_that_css_asks_for() {
    let fonts = fonts();
    let draw =
        |text: &str| draw_with(document(&format!("<text y='30' {text}</text>")).as_bytes(), &fonts);
    let (upper, messages) = draw("style='text-transform:uppercase'>ab");
    assert_eq!(messages, Vec::<String>::new());
    assert!(upper == draw(">AB").0 && upper != draw(">ab").0);
    assert!(draw("style='text-transform:capitalize'>a bc").0 == draw(">A Bc").0);
    assert!(
        draw("style='font:italic 700 20px sans-serif'>a").0
            == draw("font-size='20' font-weight='700' font-style='italic'>a").0
    );
}

#[test]
fn drawings_are_read_in_their_encoding() {
    let body = document(
        "<style>[id='\u{fc}']{fill:lime}</style><rect id='\u{fc}' width='40' height='40'/>",
    );
    let declared = |label: &str| format!("<?xml version='1.0' encoding='{label}'?>{body}");
    let latin: Vec<u8> = declared("ISO-8859-1").chars().map(|c| c as u8).collect();
    let utf16: Vec<u8> = format!("\u{feff}{}", declared("UTF-16"))
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    for bytes in [latin, utf16, declared("UTF-8").into_bytes()] {
        let (picture, messages) = draw_with(&bytes, &Fonts::new());
        assert_eq!((picture.get(20, 20), messages), (Some(LIME), Vec::new()));
    }
}

/// Base64 of RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let digits = |three: &[u8]| {
        let bits =
            three.iter().chain(&[0; 2]).take(3).fold(0_u32, |bits, b| bits << 8 | u32::from(*b));
        let digit = |i: usize| {
            if i > three.len() {
                '='
            } else {
                char::from(DIGITS[(bits >> (18 - 6 * i)) as usize & 63])
            }
        };
        (0..4).map(digit).collect::<String>()
    };
    bytes.chunks(3).map(digits).collect()
}

#[test]
fn pictures_of_many_kinds_are_painted() {
    // One lime pixel each.
    let bmp = "Qk06AAAAAAAAADYAAAAoAAAAAQAAAAEAAAABABgAAAAAAAQAAAAAAAAAAAAAAAAAAAAAAAAAAP8AAA==";
    let gif =
        base64(b"GIF89a\x01\0\x01\0\x80\0\0\0\xff\0\0\0\0,\0\0\0\0\x01\0\x01\0\0\x02\x02D\x01\0;");
    let svg =
        base64(document("<style>rect{fill:lime}</style><rect width='40' height='40'/>").as_bytes());
    for (kind, data) in
        [("image/bmp", bmp), ("image/gif", &gif), ("image/svg+xml", &svg), ("", bmp)]
    {
        let body = format!("<image {RECT} xlink:href='data:{kind};base64,{data}'/>");
        assert_eq!(painted(&body).get(20, 20), Some(LIME), "{kind}");
    }
    let (picture, messages) =
        draw("<rect/>\n<image width='9' height='9' href='data:image/png;base64,iVBORw0KGgo='/>");
    assert_eq!(extent(&picture), None);
    assert!(messages.len() == 1 && messages[0].starts_with("line 2, column 29: image `data:image/png;base64,iVBORw0KGgo=` is left out: it is cut off"), "{messages:?}");
    let (_, messages) = draw("<image width='9' height='9' href='data:image/avif;base64,AAAA'/>");
    assert!(messages.len() == 1 && messages[0].contains("is neither PNG nor JPEG"), "{messages:?}");
}

/// Markers that show their direction by a square of 4 × 4 in front of a vertex.
const MARKER: &str = "<marker id='m' orient='auto' markerWidth='9' markerHeight='9' refX='0' refY='2' markerUnits='userSpaceOnUse'>
    <rect width='4' height='4' fill='lime'/></marker>";

#[test]
fn markers_stand_at_vertices_alone() {
    let count = |body: &str| {
        let picture = painted(&format!("{MARKER}{body}"));
        picture.data().iter().map(|p| u32::from(p[3])).sum::<u32>() / 255 / 15
    };
    // An arc is one segment, however many curves it becomes.
    assert_eq!(count("<path fill='none' marker-mid='url(#m)' d='M5 20A15 15 0 0 1 35 20'/>"), 0);
    assert_eq!(
        count("<g style='marker:url(#m)'><path fill='none' d='M10 20A10 10 0 0 1 30 20'/></g>"),
        2
    );
    // Elements without a path have no markers.
    assert_eq!(count("<circle cx='20' cy='20' r='12' fill='none' style='marker:url(#m)'/>"), 0);
    let used = "<defs><path id='p' fill='none' d='M10 20q9 0 10 10' marker-end='url(#m)'/></defs><use href='#p'/>";
    assert_eq!(count(used), 1);
}

#[test]
fn markers_of_closed_paths_look_half_way() {
    let square = "d='M10 10H30V30H10Z' fill='none'";
    for (marker, expected) in
        [("marker-start", [[12, 8], [8, 12]]), ("marker-end", [[12, 8], [8, 12]])]
    {
        let picture = painted(&format!("{MARKER}<path {square} {marker}='url(#m)'/>"));
        // At the first corner, halfway between up (the last side) and right (the first side): to the upper right.
        let seen = expected.map(|[x, y]| picture.get(x, y).unwrap()[3] > 200);
        assert_eq!(seen, [true, false], "{marker}");
    }
    // If control points coincide with an end, the others give the direction.
    let curve = "<path d='M5 20C5 20 20 20 20 20' fill='none' marker-end='url(#m)'/>";
    assert_eq!(extent(&painted(&format!("{MARKER}{curve}"))), Some([20, 18, 24, 22]));
}

#[test]
fn pictures_stand_upright() {
    // 16 × 8 pixels, the right half white, with the orientation "turn by 90° clockwise".
    let jpeg = "/9j/4AAQSkZJRgABAQAAAQABAAD/4QAiRXhpZgAATU0AKgAAAAgAAQESAAMAAAABAAYAAAAAAAD/2wBDAAgGBgcGBQgHBwcJCQgKDBQNDAsL\
                DBkSEw8UHRofHh0aHBwgJC4nICIsIxwcKDcpLDAxNDQ0Hyc5PTgyPC4zNDL/wAALCAAIABABAREA/8QAFAABAAAAAAAAAAAAAAAAAAAACP/E\
                ABQQAQAAAAAAAAAAAAAAAAAAAAD/2gAIAQEAAD8AP5/v/9k=";
    let picture = painted(&format!("<image x='10' href='data:image/jpeg;base64,{jpeg}'/>"));
    assert_eq!(extent(&picture), Some([10, 0, 18, 16]), "as high as it was wide");
    let [above, below] = [3, 12].map(|y| picture.get(14, y).unwrap()[0]);
    assert!(above < 30 && below > 225, "{above} {below}");
    let webp = "UklGRhwAAABXRUJQVlA4TA8AAAAvAAAAAAfQ/4j+ByKi/wEA";
    let picture = painted(&format!("<image {RECT} href='data:image/webp;base64,{webp}'/>"));
    assert_eq!(picture.get(20, 20), Some(LIME));
}

#[test]
fn spaced_words_and_spans_keep_their_gaps() {
    let fonts = fonts();
    let draw = |body: &str| draw_with(document(body).as_bytes(), &fonts).0;
    // Without ligatures, spaced text has every letter where it would be by itself.
    let spaced = draw(
        "<text y='30' font-size='10' letter-spacing='3'> o<tspan letter-spacing='5'>x </tspan>o </text>",
    );
    let placed = draw(
        "<text y='30' font-size='10'>o<tspan dx='3'>x</tspan><tspan dx='5'> </tspan><tspan dx='5'>o</tspan></text>",
    );
    assert_eq!(extent(&spaced), extent(&placed));
    // As in browsers, the last letter is followed by space too, which matters for centred text.
    let middle = |x: u32| {
        draw(&format!(
            "<text x='{x}' y='30' font-size='10' text-anchor='middle' letter-spacing='4'>oo</text>"
        ))
    };
    let [left, _, right, _] = extent(&middle(20)).unwrap();
    assert!((left + right).abs_diff(2 * 20 - 4) <= 1, "{left} {right}");
}

#[test]
fn pictures_are_no_paint() {
    // Browsers paint nothing, or the fallback.
    let (picture, _) = draw("<rect width='9' height='9' fill='url(a.png)'/>");
    assert_eq!(extent(&picture), None);
    let (picture, _) = draw("<rect width='9' height='9' fill='url(a.svg#b) red'/>");
    assert_eq!(extent(&picture), Some([0, 0, 9, 9]));
    // Ordinary underlines give no warning.
    let (_, messages) = draw("<g text-decoration='underline' vector-effect='none'/>");
    assert!(messages.is_empty(), "{messages:?}");
}
