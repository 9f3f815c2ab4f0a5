//! The page of `sig info --html`, in a browser.

use std::fs;
use std::io::BufReader;
use std::path::Path;
use std::process::Command;

use crate::data;

/// How many pixels of a picture have about each of some colours.
fn counts(path: &Path, colours: &[[u8; 3]]) -> Vec<usize> {
    let mut decoder = png::Decoder::new(BufReader::new(fs::File::open(path).unwrap()));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let is_near = |pixel: &[u8], colour: &[u8; 3]| pixel.iter().zip(colour).all(|(a, b)| a.abs_diff(*b) <= 6);
    let samples = info.color_type.samples();
    colours.iter().map(|colour| pixels.chunks_exact(samples).filter(|pixel| is_near(pixel, colour)).count()).collect()
}

#[test]
fn a_page_shows_counts_charts_and_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let run = |arguments: &[&str]| {
        let output =
            Command::new(env!("CARGO_BIN_EXE_sig")).args(arguments).current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    let mesh = data("gmsh_mixed_bracket_h0.9.msh");
    run(&["build", mesh.to_str().unwrap(), "-o", "bracket.sigc"]);
    run(&["info", "bracket.sigc", "--html", "bracket.html"]);
    let page = fs::read_to_string(path("bracket.html")).unwrap();
    // It needs no other file: all addresses are those of names in XML.
    let addresses: Vec<&str> =
        page.split("http").skip(1).map(|rest| rest.split(['"', '<']).next().unwrap_or("")).collect();
    assert!(addresses.iter().all(|address| address.starts_with("://www.w3.org/")), "{addresses:?}");
    for text in ["1,199 tetrahedra", "189 dangling triangles", "49 wire edges", "paper, 4.2", "Singularities", "1,199"]
    {
        assert!(page.contains(text), "{text}");
    }
    let browser = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
    let Some(browser) = browser.into_iter().find(|browser| Path::new(browser).exists()) else {
        eprintln!("SKIPPED: no Chromium to open the page with");
        return;
    };
    let shot = path("shot.png");
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=1000,3600"])
        .arg(format!("--user-data-dir={}", path("profile").display()))
        .arg(format!("--screenshot={}", shot.display()))
        .arg(format!("file://{}", path("bracket.html").display()))
        .output()
        .unwrap();
    assert!(shot.exists(), "{}", String::from_utf8_lossy(&output.stderr));
    let colours = [[255, 255, 255], [0, 114, 178], [214, 0, 84], [34, 34, 34]];
    let [white, bars, singular, letters] = counts(&shot, &colours)[..] else { unreachable!() };
    let all = 1000 * 3600;
    assert!(white > all / 3 && white < all * 19 / 20, "{white} of {all} are white");
    assert!(bars > 10_000, "{bars} pixels of bars");
    assert!(singular > 50, "{singular} pixels of singular simplices");
    assert!(letters > 500, "{letters} pixels of letters");
}
