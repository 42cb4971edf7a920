//! `durer batch`: manifests, journals, failures, resumed runs.

use crate::harness::{BROKEN, CUBE, Ended, Folder};
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::process::Stdio;

/// Options for small pictures.
const SMALL: &str = "--size 8 --aa 1";

fn cubes(rows: &str) -> Folder {
    let folder = Folder::with_models();
    folder.write("rows.csv", format!("id,input\n{rows}"));
    folder
}

fn batch(folder: &Folder, options: &str) -> Ended {
    folder.run(&format!("batch rows.csv -o out {options} -- render {SMALL}"))
}

/// Returns the lines of the journal of all rows.
fn journal(folder: &Folder) -> Vec<Value> {
    let text = folder.read("out/.durer/shard-0-of-1.jsonl");
    let lines = text.split(|&b| b == b'\n').filter(|line| !line.is_empty());
    lines.map(|line| serde_json::from_slice(line).unwrap()).collect()
}

#[test]
fn rows_are_run_and_noted() {
    let folder = cubes("b/cube,cube.obj\nbroken,broken.obj\ngone,gone.obj\n");
    let ended = batch(&folder, "--jobs 2");
    ended.fails(3, "durer: broken: broken.obj: line 3").fails(3, "gone: gone.obj: No such file");
    ended.fails(3, "1 row done, 2 failed");
    folder.must(&format!("render cube.obj -o direct.png {SMALL}"));
    assert_eq!(folder.read("out/b/cube.png"), folder.read("direct.png"));
    let mut entries = journal(&folder);
    entries.sort_by_key(|entry| entry["id"].as_str().unwrap().to_owned());
    let of = |name: &str| entries.iter().map(|e| e[name].clone()).collect::<Vec<_>>();
    assert_eq!(of("status"), ["done", "failed", "failed"]);
    assert_eq!(of("output"), ["b/cube.png", "broken.png", "gone.png"]);
    assert_eq!(entries[0]["bytes"], folder.read("direct.png").len());
    assert_eq!(entries[1]["error"]["kind"], "data");
    assert_eq!(entries[1]["error"]["place"], "broken.obj: line 3, column 5");
    assert_eq!(entries[2]["error"]["kind"], "read");
    assert_eq!(entries[2]["key"], Value::Null);
    let names = fs::read_dir(folder.path("out/.durer")).unwrap();
    let mut names: Vec<_> = names.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["shard-0-of-1.jsonl", "shard-0-of-1.lock"]);
}

#[test]
fn manifests_are_checked_before_any_row_is_run() {
    let folder = Folder::with_models();
    for (rows, error) in [
        (
            "id,input,colour\na,cube.obj,red\n",
            "line 2: column `colour`: `durer render` has no such",
        ),
        ("id,input,window\na,cube.obj,1\n", "`durer clip` has it"),
        ("id,input\na,cube.obj\nb,cube.obj\na,cube.obj\n", "line 4: id `a` is used in line 2, too"),
        ("id,input\na b,cube.obj\n", "line 2: id `a b`: it has letters"),
        ("id,input\n../a,cube.obj\n", "line 2: id `../a`: no part"),
        (
            "id,input,output\na,cube.obj,x.png\nb,cube.obj,x.png\n",
            "line 3: output `x.png` is used in line 2, too",
        ),
        ("id,input,output\na,cube.obj,a.png\nb,cube.obj,../b.png\n", "within OUT"),
        ("id,input,output\na,cube.obj,.durer/a.png\n", "the journal"),
        ("id,input,depth\na,cube.obj,a.png\n", "output `a.png` is used in line 2, too"),
        ("id,input,threads\na,cube.obj,4\n", "column `threads`"),
        ("id,input\na,cube.obj,8\n", "line 2: it has 3 cells; the header has 2"),
        ("name,input\na,cube.obj\n", "line 1: there is no column `id`"),
        ("id,input\na,\n", "line 2: there is no `input`"),
        ("id,input\na,-\n", "line 2: column `input`: `-` is not a file"),
        ("id,input,command\na,cube.obj,explain\n", "command `explain` is not one of render, clip"),
        ("id,input,sha256\na,cube.obj,12\n", "64 hexadecimal digits"),
        ("{\"id\":\"a\",\"input\":\"cube.obj\"}\n{\"id\":\n", "line 2: column 6: EOF"),
        ("{\"id\":\"a\",\"input\":\"cube.obj\"}\n[1]\n", "line 2: it is not an object"),
        (
            "{\"id\":\"a\",\"input\":\"cube.obj\",\"no-color-bar\":3,\"command\":\"plot\"}\n",
            "it is a flag: true or false",
        ),
        ("PAR1", "--features geoparquet"),
    ] {
        if cfg!(feature = "geoparquet") && rows == "PAR1" {
            continue;
        }
        folder.write("rows.csv", rows);
        folder.run("batch rows.csv -o out").fails(1, error).fails(1, "rows.csv: ");
    }
    assert!(!folder.path("out").exists(), "nothing was begun");
    folder.write("rows.csv", "id,input\na,cube.obj\n");
    let run = |options: &str| folder.run(&format!("batch rows.csv -o out {options}"));
    for (options, error) in [
        ("-- render --sise 8", "unexpected argument '--sise'"),
        ("-- explain", "`explain` is not one of render, clip"),
        ("-- --size 8 cube.obj", "inputs are in the manifest"),
        ("-- --output a.png", "--name or the column `output`"),
        ("-- --timeout 3", "--timeout: it is not an option of rows"),
        ("--name {id}/../{stem}.png", "within OUT"),
        ("--name {it}.png", "there are {id}, {stem}"),
        ("--name {id}", "it needs a suffix"),
        ("--shard 3/3", "a shard is I/N with I below N"),
        ("--resume --restart", "cannot be used with"),
    ] {
        run(options).fails(2, error);
    }
    folder.run("batch none.csv -o out").fails(1, "none.csv: No such file");
    assert!(!folder.path("out").exists(), "nothing was begun");
}

#[test]
fn a_row_fails_alone() {
    let folder = Folder::with_models();
    let huge = "v 0 0 0\n".repeat(1 << 20);
    folder.write("huge.obj", huge);
    let digits = "0".repeat(64);
    let rows = [
        "{\"id\":\"huge\",\"input\":\"huge.obj\"}".to_owned(),
        "{\"id\":\"size\",\"input\":\"cube.obj\",\"size\":\"none\"}".to_owned(),
        format!("{{\"id\":\"sum\",\"input\":\"cube.obj\",\"sha256\":\"{digits}\"}}"),
        "{\"id\":\"data\",\"input\":\"data:,x\"}".to_owned(),
        "{\"id\":\"uri\",\"input\":\"data:;base64,*\"}".to_owned(),
        "{\"id\":\"fine\",\"input\":\"cube.obj\"}".to_owned(),
    ];
    folder.write("rows.csv", rows.join("\n"));
    batch(&folder, "--jobs 1 --max-memory 20M").fails(3, "1 row done, 5 failed");
    let entries = journal(&folder);
    let of = |id: &str| entries.iter().find(|e| e["id"] == id).unwrap();
    for (id, kind) in [
        ("huge", "memory"),
        ("size", "usage"),
        ("sum", "checksum"),
        ("data", "data"),
        ("uri", "read"),
    ] {
        assert_eq!(of(id)["error"]["kind"], kind, "{}", of(id));
    }
    assert_eq!(of("fine")["status"], "done");
}

#[test]
fn rows_have_options_of_their_own() {
    let folder = Folder::with_models();
    folder.write("points.geojson", r#"{"type":"MultiPoint","coordinates":[[-90,45],[90,45]]}"#);
    folder.write(
        "rows.csv",
        "{\"id\":\"a\",\"input\":\"cube.obj\",\"size\":4,\"azimuth\":20,\"depth\":\"{id}-depth.png\"}\n\
         {\"id\":\"b\",\"input\":\"cube.obj\",\"edges\":true,\"light\":[\"ambient:white:0.2\",\"directional:-1,-2,-1\"]}\n\
         {\"id\":\"c\",\"command\":\"info\",\"input\":\"cube.obj\"}\n\
         {\"id\":\"d\",\"command\":\"clip\",\"input\":\"points.geojson\",\"window\":\"-180,0,0,90\"}\n\
         {\"id\":\"e\",\"command\":\"draw\",\"input\":\"points.geojson\",\"size\":\"8x8\"}\n\
         {\"id\":\"f\",\"command\":\"tiles\",\"input\":[\"points.geojson\"],\"zoom\":\"0-1\"}\n\
         {\"id\":\"g\",\"command\":\"plot\",\"formula\":\"x*z\",\"output\":\"g.svg\"}\n\
         {\"id\":\"h\",\"input\":\"data:model/obj,v 0 0 0%0Av 1 0 0%0Av 0 1 0%0Af 1 2 3%0A\"}\n",
    );
    let ended = folder.run("batch rows.csv -o out --jobs 1 -- render --size 8 --aa 1 --view front");
    assert_eq!(ended.code, 0, "{}", ended.err);
    let size = |name: &str| crate::harness::Picture::decode(&folder.read(name)).size();
    assert_eq!(
        [size("out/a.png"), size("out/a-depth.png"), size("out/b.png")],
        [(4, 4), (4, 4), (8, 8)]
    );
    assert_eq!(
        serde_json::from_slice::<Value>(&folder.read("out/c.json")).unwrap()["triangles"],
        12
    );
    for (command, name) in [
        // Of two options that exclude each other, the row's option wins.
        ("render cube.obj --size 4 --aa 1 --azimuth 20", "a.png"),
        (
            "render cube.obj --size 8 --aa 1 --view front --edges --light ambient:white:0.2 --light directional:-1,-2,-1",
            "b.png",
        ),
        ("clip points.geojson --window -180,0,0,90", "d.geojson"),
        ("draw points.geojson --size 8x8", "e.png"),
        ("plot --formula x*z", "g.svg"),
    ] {
        folder.must(&format!("{command} -o {name}"));
        assert_eq!(folder.read(&format!("out/{name}")), folder.read(name), "{name}");
    }
    assert!(folder.path("out/f.pmtiles").is_file() && folder.path("out/h.png").is_file());
    let entries = journal(&folder);
    let a = entries.iter().find(|e| e["id"] == "a").unwrap();
    assert_eq!(a["planes"][0]["output"], "a-depth.png");
}

#[test]
fn resuming_runs_what_changed_and_nothing_else() {
    let folder = cubes("a,cube.obj\nb,second.obj\nbroken,broken.obj\ngone,gone.obj\n");
    folder.write("second.obj", CUBE);
    batch(&folder, "--jobs 1").fails(3, "2 rows done, 2 failed");
    batch(&folder, "--jobs 1").fails(2, "--resume continues, --restart runs all again");
    let rows = || journal(&folder).len();
    assert_eq!(rows(), 4);
    // A row whose input was missing is tried again; a row whose input is wrong is not.
    batch(&folder, "--jobs 1 --resume").fails(3, "0 rows done, 2 done before, 2 failed");
    assert_eq!(rows(), 5);
    batch(&folder, "--jobs 1 --retry failed").fails(3, "0 rows done, 2 done before, 2 failed");
    assert_eq!(rows(), 7);
    // Input, output, and options that changed.
    folder.write("gone.obj", CUBE);
    folder.write("broken.obj", CUBE);
    folder.write("second.obj", format!("# Another one.\n{CUBE}"));
    folder.write("out/a.png", "cut");
    assert!(batch(&folder, "--jobs 1 --resume").err.contains("4 rows done;"));
    assert!(batch(&folder, "--jobs 1 --resume").err.contains("0 rows done, 4 done before;"));
    let bigger = "batch rows.csv -o out --jobs 1 --resume -- render --size 9 --aa 1";
    assert!(folder.must(bigger).err.contains("4 rows done;"));
    assert_eq!(rows(), 15);
    assert!(batch(&folder, "--jobs 1 --restart").err.contains("4 rows done;"));
    assert_eq!(rows(), 4);
}

#[test]
fn files_that_inputs_refer_to_count() {
    let folder = cubes("a,x/cube.obj\n");
    fs::create_dir(folder.path("x")).unwrap();
    folder.write("x/cube.obj", format!("mtllib cube.mtl\nusemtl one\n{CUBE}"));
    let run = || batch(&folder, "--jobs 1 --resume").err;
    assert!(run().contains("1 row done"));
    assert_eq!(
        journal(&folder)[0]["read"],
        serde_json::json!([{"path": "cube.mtl", "sha256": null}])
    );
    assert!(run().contains("1 done before"));
    folder.write("x/cube.mtl", "newmtl one\nKd 1 0 0\n");
    assert!(run().contains("1 row done"));
    assert!(run().contains("1 done before"));
    folder.write("x/cube.mtl", "newmtl one\nKd 0 0.5 0\n");
    assert!(run().contains("1 row done"));
}

#[test]
fn torn_lines_are_rows_that_were_not_run() {
    let folder = cubes("a,cube.obj\nb,cube.obj\n");
    batch(&folder, "--jobs 1");
    let name = "out/.durer/shard-0-of-1.jsonl";
    let whole = folder.read(name);
    let first = whole.iter().position(|&b| b == b'\n').unwrap() + 1;
    for torn in [&whole[..first + 40], &whole[..whole.len() - 1], &whole[first..first + 9]] {
        folder.write(name, torn);
        let begun = torn.iter().filter(|&&b| b == b'\n').count();
        let ended = batch(&folder, "--jobs 1 --resume");
        let done = ["2 rows done", "1 row done"][begun];
        assert!(ended.err.contains(done), "{}", ended.err);
        assert_eq!(journal(&folder).len(), 2);
    }
}

#[test]
fn shards_divide_the_rows_and_are_locked() {
    let rows: String = (0..9).map(|i| format!("row-{i},cube.obj\n")).collect();
    let folder = cubes(&rows);
    let mut counts = 0;
    for shard in 0..3 {
        let ended = batch(&folder, &format!("--jobs 1 --shard {shard}/3"));
        assert_eq!(ended.code, 0, "{}", ended.err);
        counts += ended.err.split(' ').nth(1).unwrap().parse::<u32>().unwrap();
    }
    assert_eq!(counts, 9);
    // Rows done by shards count as done, whatever the number of shards.
    assert!(batch(&folder, "--resume").err.contains("0 rows done, 9 done before"));
    let lock = fs::File::open(folder.path("out/.durer/shard-1-of-3.lock")).unwrap();
    lock.lock().unwrap();
    batch(&folder, "--resume --shard 1/3").fails(1, "another process works on shard 1/3");
    assert_eq!(batch(&folder, "--resume --shard 0/3").code, 0);
    drop(lock);
    let mut auto = folder.command("batch rows.csv -o out --resume --shard auto -- --size 8 --aa 1");
    auto.env("SLURM_ARRAY_TASK_ID", "1")
        .env("SLURM_ARRAY_TASK_MIN", "0")
        .env("SLURM_ARRAY_TASK_COUNT", "3");
    assert_eq!(Ended::of(auto.output().unwrap()).code, 0);

    folder.write("broken.obj", BROKEN);
    folder.write("rows.csv", "id,input\nrow-0,cube.obj\nnew,broken.obj\n");
    batch(&folder, "--resume");
    folder.run("batch --merge out -o report.csv").fails(0, "10 rows: 9 done, 1 failed");
    let report = String::from_utf8(folder.read("report.csv")).unwrap();
    let lines: Vec<&str> = report.lines().collect();
    assert!(
        lines[0].starts_with("id,status,output,bytes,sha256,seconds,warnings,error"),
        "{report}"
    );
    assert!(
        lines[1].starts_with("new,failed,new.png,")
            && lines[1].contains(",data,\"broken.obj: line 3, column 5\","),
        "{report}"
    );
    assert!(lines[2].starts_with("row-0,done,row-0.png,") && lines.len() == 11, "{report}");
    folder.must("batch --merge out -o report.jsonl");
    assert_eq!(folder.read("report.jsonl").iter().filter(|&&b| b == b'\n').count(), 10);
    folder.run("batch --merge out -o report.txt").fails(2, "a report is .csv, .jsonl or .parquet");
    folder.run("batch --merge nowhere -o report.csv").fails(1, "nowhere");
}

#[test]
fn manifests_come_from_standard_input_too() {
    let folder = Folder::with_models();
    let mut command =
        folder.command("batch - -o out --quiet --name {folder}/{stem}-{id}.jpg -- --size 8");
    let mut child = command.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(b"\xef\xbb\xbfid,input\n1,./cube.obj\n").unwrap();
    let ended = Ended::of(child.wait_with_output().unwrap());
    assert!(ended.code == 0 && ended.err.is_empty(), "{ended:?}");
    assert!(folder.read("out/cube-1.jpg").starts_with(b"\xff\xd8"));
}

#[test]
fn a_failed_row_can_be_the_last() {
    let folder = cubes("a,broken.obj\nb,cube.obj\nc,cube.obj\n");
    let ended = batch(&folder, "--jobs 1 --on-error stop");
    ended.fails(3, "0 rows done, 1 failed, 2 not run; --resume continues");
    assert_eq!(journal(&folder).len(), 1);
}

#[cfg(unix)]
#[test]
fn a_row_that_takes_too_long_is_ended() {
    let folder = Folder::with_models();
    // A pipe without a writer.
    let made = std::process::Command::new("mkfifo").arg(folder.path("pipe.obj")).status();
    assert!(made.unwrap().success());
    folder.write("rows.csv", "id,input\na,pipe.obj\nb,cube.obj\n");
    let ended = batch(&folder, "--jobs 1 --timeout-per-row 0.2");
    ended.fails(3, "1 row done, 1 failed");
    assert_eq!(journal(&folder)[0]["error"]["kind"], "timeout", "{}", ended.err);
}

#[cfg(unix)]
#[test]
fn confined_rows_write_within_out() {
    let folder = Folder::with_models();
    ["in", "out", "away"].iter().for_each(|name| fs::create_dir(folder.path(name)).unwrap());
    folder.write("in/cube.obj", CUBE);
    std::os::unix::fs::symlink(folder.path("away"), folder.path("out/link")).unwrap();
    folder.write("rows.csv", "id,input\nplain,in/cube.obj\nlink/a,cube.obj\n");
    assert_eq!(batch(&folder, "").code, 0);
    assert!(folder.path("away/a.png").exists());
    fs::remove_file(folder.path("away/a.png")).unwrap();
    let ended = batch(&folder, "--restart --sandbox");
    if ended.code == 2 {
        ended.fails(2, "--sandbox=best-effort");
        let ended = batch(&folder, "--restart --sandbox=best-effort");
        assert!(ended.code == 0 && ended.err.contains("durer: warning: --sandbox"), "{ended:?}");
        println!("skipped: the system does not confine processes");
        return;
    }
    ended.fails(3, "1 row done, 1 failed");
    assert!(!folder.path("away/a.png").exists());
    let entries = journal(&folder);
    let of_link = entries.iter().find(|entry| entry["id"] == "link/a").unwrap();
    assert_eq!(of_link["error"]["kind"], "write", "{of_link}");
}

#[test]
fn tables_of_spreadsheets_and_python_are_read() {
    let folder = Folder::with_models();
    for table in [
        "id;input;grid;edges\na;cube.obj;TRUE;false\nb;cube.obj;False;\n",
        "id, input, grid, edges\na, cube.obj , True, False\nb, cube.obj, false,\n",
        "id\tinput\tgrid\tedges\na\tcube.obj\ttrue\tFALSE\nb\tcube.obj\tfalse\t\n",
    ] {
        folder.write("rows.csv", table);
        let ended = batch(&folder, "--restart");
        assert_eq!(ended.code, 0, "{table}: {}", ended.err);
        folder.must(&format!("render cube.obj -o grid.png --grid {SMALL}"));
        folder.must(&format!("render cube.obj -o plain.png {SMALL}"));
        assert_eq!(folder.read("out/a.png"), folder.read("grid.png"), "{table}");
        assert_eq!(folder.read("out/b.png"), folder.read("plain.png"), "{table}");
    }
    for (table, printed) in [
        ("ID;input\na;cube.obj\n", "there is no column `id` among ID, input"),
        ("[{\"id\":\"a\"}]", "it is an array of JSON; write each of its objects on a line"),
    ] {
        folder.write("rows.csv", table);
        batch(&folder, "").fails(1, printed);
    }
    fs::create_dir(folder.path("tables")).unwrap();
    fs::copy(folder.path("cube.obj"), folder.path("tables/own.obj")).unwrap();
    folder.write("tables/rows.csv", "id,input\na,own.obj\n");
    let ended = folder.run(&format!("batch tables/rows.csv -o there -- render {SMALL}"));
    ended.fails(3, "inputs are named from the current folder, not from the manifest's");
    folder.write("a.geojson", r#"{"type":"Point","coordinates":[1,2]}"#);
    folder.write("rows.csv", "id,input,to\na,a.geojson,fgb\n");
    let ended = folder.run("batch rows.csv -o maps -- clip");
    assert_eq!((ended.code, folder.path("maps/a.fgb").exists()), (0, true), "{}", ended.err);
}
