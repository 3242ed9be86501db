//! Lists of videos: one that fails leaves the others, what is finished stays, and nothing is lost or made twice
//! when processes that share a list are killed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

use mouthpiece_tests::binary::{self, Running};
use mouthpiece_tests::{fixtures, or_skipped};
use serde_json::Value;
use tempfile::TempDir;

use crate::export::{SHORT, names, text};
use crate::graphics;

/// What is waited for comes within seconds, on a busy machine within a minute.
const PATIENCE: Duration = Duration::from_secs(120);

/// Options that make the smallest videos.
const SMALL: [&str; 6] = ["--size", "64x48", "--fps", "10", "--tier", "low"];

/// A folder with labels and a list in it.
struct Lists {
    folder: TempDir,
}

impl Lists {
    fn new() -> Self {
        let lists = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        fs::write(lists.at("short.phn"), SHORT).unwrap();
        lists
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, text: &str) -> String {
        fs::write(self.at(name), text).unwrap();
        crate::export::text(&self.at(name))
    }

    /// The command on this list, with the smallest pictures.
    fn command(&self, list: &str, more: &[&str]) -> Command {
        let list = text(&self.at(list));
        let args = [&["export", "--jobs", &list], &SMALL[..], more].concat();
        let mut command = binary::command(&args);
        command.stdout(Stdio::null());
        command
    }

    fn run(&self, list: &str, more: &[&str]) -> binary::Finished {
        binary::start(&mut self.command(list, more)).finish()
    }

    /// Everything in a folder but the hidden records, none of which is a half-made file.
    fn outputs(&self, folder: &str) -> Vec<String> {
        let mut found = names(&self.at(folder));
        found.retain(|name| name != ".mouthpiece");
        assert!(!found.iter().any(|name| name.starts_with('.')), "{found:?}");
        found
    }

    /// What the report says of each row.
    fn states(&self, report: &str) -> Vec<String> {
        let report = self.report(report);
        let jobs = report["jobs"].as_array().unwrap().iter();
        jobs.map(|job| job["state"].as_str().unwrap().to_owned())
            .collect()
    }

    fn report(&self, name: &str) -> Value {
        serde_json::from_slice(&fs::read(self.at(name)).unwrap()).unwrap()
    }
}

/// The lines that say what failed.
fn sentences(finished: &binary::Finished) -> Vec<&str> {
    assert!(!finished.stderr.contains("panicked"), "{}", finished.stderr);
    let lines = finished.stderr.lines();
    lines
        .filter_map(|line| line.strip_prefix("mouthpiece: "))
        .collect()
}

/// Guards the list: rows as options of `export`, outputs as those of single exports to the byte; a second
/// run makes only what has changed or is gone.
#[test]
fn a_list_is_made_once_and_then_only_what_has_changed() {
    if !graphics::are_there_for("a list of videos") {
        return;
    }
    let lists = Lists::new();
    lists.write("other.phn", SHORT);
    fs::create_dir(lists.at("out")).unwrap();
    lists.write(
        "list.csv",
        "labels,output,seed,expression,size\nshort.phn,a.mp4,1,,\nshort.phn,b.mp4,2,smile,\n\
         other.phn,c.mp4,,,32x32\nother.phn,f-%02d.png,,,\n",
    );
    let (report, out) = (text(&lists.at("report.json")), text(&lists.at("out")));
    let more = ["--output-dir", &out, "--report", &report, "--parallel", "2"];
    lists.run("list.csv", &more).expect_done();
    let frames = ["f-00.png", "f-01.png", "f-02.png", "f-03.png"];
    let made = [&["a.mp4", "b.mp4", "c.mp4"], &frames[..]].concat();
    assert_eq!(lists.outputs("out"), made);
    assert_eq!(lists.states("report.json"), ["done"; 4]);
    assert!(lists.report("report.json")["jobs"][0]["realtime_factor"].as_f64() > Some(0.0));

    let (labels, single) = (text(&lists.at("short.phn")), text(&lists.at("single.mp4")));
    let alone = [
        "export",
        "--labels",
        &labels,
        "--seed",
        "2",
        "--expression",
        "smile",
        "-o",
        &single,
    ];
    binary::run(&[&alone[..], &SMALL[..]].concat()).expect_done();
    let same = fs::read(lists.at("out/b.mp4")).unwrap() == fs::read(&single).unwrap();
    assert!(same, "a row and a single export differ");

    lists.run("list.csv", &more).expect_done();
    assert_eq!(lists.states("report.json"), ["unchanged"; 4]);

    fs::remove_file(lists.at("out/a.mp4")).unwrap();
    fs::remove_file(lists.at("out/b.mp4")).unwrap();
    fs::write(
        lists.at("other.phn"),
        SHORT.replace("aa", "iy").replace("6400", "5000"),
    )
    .unwrap();
    lists.run("list.csv", &more).expect_done();
    assert_eq!(lists.states("report.json"), ["done"; 4]);
    lists
        .run("list.csv", &[&more[..], &["--seed", "9"]].concat())
        .expect_done();
    let wanted = ["unchanged", "unchanged", "done", "done"];
    assert_eq!(
        lists.states("report.json"),
        wanted,
        "a seed of the row's own counts more"
    );
}

/// Guards the others: each broken row is one sentence with its line, and all else is made.
#[test]
fn a_row_that_fails_leaves_the_others() {
    if !graphics::are_there_for("a list with broken rows") {
        return;
    }
    let lists = Lists::new();
    lists.write(
        "list.ndjson",
        "{\"labels\": \"short.phn\", \"output\": \"a.mp4\"}\n\
         {\"lables\": \"short.phn\", \"output\": \"b.mp4\"}\n\
         {\"labels\": \"none.phn\", \"output\": \"c.mp4\"}\n\
         {\"labels\": \"short.phn\", \"output\": \"d.mp4\", \"size\": \"64\"}\n\
         \n\
         {\"labels\": \"short.phn\", \"output\": \"a.mp4\"}\n\
         {\"labels\": \"short.phn\",\n\
         {\"labels\": \"short.phn\", \"output\": \"short.phn/e.mp4\"}\n\
         {\"labels\": \"short.phn\", \"output\": \"z.mp4\", \"fps\": 12.5}\n",
    );
    let report = text(&lists.at("report.json"));
    let finished = lists.run("list.ndjson", &["--report", &report, "--parallel", "1"]);
    assert_eq!(finished.code(), 1, "{}", finished.stderr);
    let said = sentences(&finished);
    for (line, part) in [
        (2, "did you mean `labels`"),
        (3, "none.phn"),
        (4, "WIDTHxHEIGHT"),
        (6, "line 1"),
        (7, "JSON"),
        (8, "cannot write"),
    ] {
        let place = format!("line {line}");
        let found = said
            .iter()
            .filter(|s| s.contains(&place) && s.contains(part));
        assert_eq!(found.count(), 1, "{place}: {part}: {said:#?}");
    }
    assert_eq!(said.len(), 7, "{said:#?}");
    assert!(said[6].contains("6 of 8 videos failed"), "{said:#?}");
    assert!(said.iter().all(|s| s.chars().count() < 400), "{said:#?}");
    let outputs = ["a.mp4", "list.ndjson", "report.json", "short.phn", "z.mp4"];
    assert_eq!(lists.outputs("."), outputs);
    let report = lists.report("report.json");
    assert_eq!((&report["done"], &report["failed"]), (&2.into(), &6.into()));
    assert!(
        report["jobs"][2]["error"]
            .as_str()
            .unwrap()
            .contains("none.phn")
    );
}

/// Guards what every row shares: said once, before any work.
#[test]
fn a_list_that_cannot_be_meant_is_refused() {
    let lists = Lists::new();
    lists.write("list.csv", "labels,outptu\nshort.phn,a.mp4\n");
    lists.write("list.txt", "labels,output\n");
    lists.write("empty.csv", "labels,output\n");
    lists.write("good.csv", "labels,output\nshort.phn,a.mp4\n");
    let bad_report = text(&lists.at("report.xml"));
    for (list, more, code, part) in [
        ("list.csv", &[][..], 1, "line 1"),
        ("list.txt", &[], 1, ".csv"),
        ("empty.csv", &[], 1, "no rows"),
        ("none.csv", &[], 1, "none.csv"),
        ("good.csv", &["--report", &bad_report], 2, ".ndjson"),
    ] {
        let finished = lists.run(list, more);
        let sentence = finished.expect_sentence(code);
        assert!(sentence.contains(part), "{sentence}");
    }
    for more in [
        &["--shard", "2/2"][..],
        &["--parallel", "0"],
        &["-o", "a.mp4"],
    ] {
        assert_eq!(lists.run("good.csv", more).code(), 2, "{more:?}");
    }
    assert!(!lists.at("a.mp4").exists());
}

/// A list of so many rows of about a second each, and its outputs' names.
fn long_list(lists: &Lists, rows: usize) -> Vec<String> {
    let utterance = fixtures::named("flite");
    let (labels, sound) = (text(&utterance.labels_path), text(&utterance.sound_path));
    let mut list = "labels,audio,output,seed\n".to_owned();
    let outputs: Vec<_> = (0..rows).map(|row| format!("v{row:02}.mp4")).collect();
    for (row, output) in outputs.iter().enumerate() {
        list += &format!("{labels},{sound},{output},{row}\n");
    }
    lists.write("list.csv", &list);
    outputs
}

/// Which outputs are there, and since when.
fn finished(lists: &Lists) -> Vec<(String, SystemTime)> {
    let all = names(lists.folder.path()).into_iter();
    let videos = all.filter(|name| name.starts_with('v') && name.ends_with(".mp4"));
    videos
        .map(|name| {
            let time = fs::metadata(lists.at(&name)).unwrap().modified().unwrap();
            (name, time)
        })
        .collect()
}

fn wait_for_outputs(lists: &Lists, wanted: usize, running: &mut [Running]) {
    let begun = Instant::now();
    while finished(lists).len() < wanted {
        assert!(begun.elapsed() < PATIENCE, "{:?}", finished(lists));
        for running in &mut *running {
            assert!(!running.has_ended(), "it ended before it was stopped");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Guards clusters: processes that share a list are killed in the middle, and started again they make all that
/// is missing, leave what was finished as it is, and leave nothing half-made.
#[test]
fn shares_of_a_list_that_are_killed_go_on_where_they_were() {
    if !graphics::are_there_for("shares of a list") {
        return;
    }
    const SHARES: usize = 3;
    let lists = Lists::new();
    let outputs = long_list(&lists, 9);
    let start = |index: usize| {
        let (shard, report) = (
            format!("{index}/{SHARES}"),
            lists.at(&format!("r{index}.json")),
        );
        let more = [
            "--shard",
            &shard,
            "--report",
            &text(&report),
            "--parallel",
            "1",
        ];
        binary::start(&mut lists.command("list.csv", &more))
    };
    let mut running: Vec<_> = (0..SHARES).map(start).collect();
    wait_for_outputs(&lists, 2, &mut running);
    running.iter().for_each(|running| running.signal("KILL"));
    for running in running {
        assert_eq!(running.finish_within(PATIENCE).code(), -1, "killed");
    }
    let before = finished(&lists);
    assert!(before.len() < outputs.len(), "nothing is left to do");
    // Whole from the first moment: the end of each is there.
    for (name, _) in &before {
        let tracks = mouthpiece_tests::mp4::tracks(&fs::read(lists.at(name)).unwrap());
        assert_eq!(tracks.len(), 2, "{name}");
    }

    for running in (0..SHARES).map(start).collect::<Vec<_>>() {
        running.finish_within(PATIENCE).expect_done();
    }
    let after = finished(&lists);
    let names: Vec<_> = after.iter().map(|(name, _)| name.clone()).collect();
    assert_eq!(names, outputs);
    lists.outputs(".");
    let mut rows = Vec::new();
    let mut kept = 0;
    for index in 0..SHARES {
        for job in lists.report(&format!("r{index}.json"))["jobs"]
            .as_array()
            .unwrap()
        {
            rows.push(job["row"].as_u64().unwrap());
            let output = Path::new(job["output"].as_str().unwrap())
                .file_name()
                .unwrap();
            let is_as_before = before
                .iter()
                .any(|entry| *entry.0 == *output && after.contains(entry));
            // The kill may have come between the output and its record: then it was made again.
            match job["state"].as_str().unwrap() {
                "unchanged" => {
                    assert!(is_as_before, "{job}");
                    kept += 1;
                }
                state => assert!(state == "done" && !is_as_before, "{job}"),
            }
        }
    }
    rows.sort_unstable();
    assert_eq!(rows, (0..9).collect::<Vec<_>>(), "each row in one share");
    assert!(
        kept + SHARES >= before.len(),
        "{kept} of {} stayed",
        before.len()
    );
}

/// Guards Ctrl-C in a list: what is finished stays, nothing is half-made, the same command goes on.
#[test]
fn ctrl_c_leaves_what_is_finished() {
    if !graphics::are_there_for("Ctrl-C in a list") {
        return;
    }
    let lists = Lists::new();
    let outputs = long_list(&lists, 6);
    let report = text(&lists.at("report.json"));
    let more = ["--report", &report, "--parallel", "2"];
    let mut running = [binary::start(&mut lists.command("list.csv", &more))];
    wait_for_outputs(&lists, 1, &mut running);
    let [running] = running;
    running.signal("INT");
    let ended = running.finish_within(PATIENCE);
    let sentence = ended.expect_sentence(130);
    assert!(sentence.contains("same command"), "{sentence}");
    let before = finished(&lists);
    assert!((1..outputs.len()).contains(&before.len()), "{before:?}");
    lists.outputs(".");
    let states = lists.states("report.json");
    let count = |state: &str| states.iter().filter(|s| *s == state).count();
    assert_eq!(
        (count("done"), count("failed")),
        (before.len(), 0),
        "{states:?}"
    );

    lists.run("list.csv", &more).expect_done();
    let after = finished(&lists);
    assert_eq!(after.len(), outputs.len());
    assert!(
        before.iter().all(|entry| after.contains(entry)),
        "made twice"
    );
}

/// Guards a disk that fills up: one sentence for each video that finds no room, no half of it, and the list goes
/// on. The disk is a small one in memory, mounted where nobody else sees it.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_fails_what_it_cannot_hold() {
    if !graphics::are_there_for("a list on a full disk") {
        return;
    }
    let may_mount = || {
        let out = Command::new("unshare").args(["-rm", "true"]).output();
        match out {
            Ok(out) if out.status.success() => Ok(()),
            _ => Err("no disk of one's own can be mounted here (unshare -rm)"),
        }
    };
    if or_skipped(may_mount()).is_none() {
        return;
    }
    let lists = Lists::new();
    fs::create_dir(lists.at("full")).unwrap();
    let utterance = fixtures::named("flite");
    let (labels, sound) = (text(&utterance.labels_path), text(&utterance.sound_path));
    let mut list = "labels,audio,output\n".to_owned();
    for output in ["full/a.mp4", "full/f-%03d.png", "b.mp4"] {
        list += &format!("{labels},{sound},{output}\n");
    }
    list += "short.phn,,full/c.mp4\n";
    lists.write("list.csv", &list);
    let inner = lists.command("list.csv", &["--parallel", "1"]);
    let script = "mount -t tmpfs -o size=40k none \"$1\" && shift && { \"$@\"; code=$?; }; ls -A full; exit $code";
    let mut command = Command::new("unshare");
    command
        .args(["-rm", "sh", "-c", script, "sh", "full"])
        .arg(inner.get_program())
        .args(inner.get_args())
        .current_dir(lists.folder.path())
        .stdin(Stdio::null())
        .stdout(Stdio::piped());
    let finished = binary::start(&mut command).finish();
    assert_eq!(finished.code(), 1, "{}", finished.stderr);
    let said = sentences(&finished);
    assert_eq!(said.len(), 3, "{said:#?}");
    for (said, output) in said.iter().zip(["a.mp4", "f-"]) {
        assert!(
            said.contains(output) && said.contains("no space left"),
            "{said}"
        );
    }
    assert!(said[2].contains("2 of 4"), "{said:#?}");
    let on_the_disk = finished.text();
    let mut on_the_disk: Vec<_> = on_the_disk.lines().collect();
    on_the_disk.sort_unstable();
    assert_eq!(on_the_disk, [".mouthpiece", "c.mp4"]);
    assert!(lists.at("b.mp4").is_file());
}
