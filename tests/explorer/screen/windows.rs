//! Windows that grow and shrink, and panes that take the whole of them.

use super::pressed;

#[test]
fn a_screen_grows_back_to_what_it_was() {
    let mut driver = pressed("");
    let before = driver.screen();
    for size in [(40, 12), (20, 5), (1, 1), (0, 0), (300, 100), (120, 40)] {
        driver.resize(size);
        // The matching snapshot arrives after the first drawing.
        driver.screen();
    }
    assert_eq!(driver.screen(), before);
}

#[test]
fn no_number_of_the_status_is_cut() {
    let mut driver = pressed("d {");
    driver.resize((200, 40));
    let whole = driver.status();
    for columns in 12..200 {
        driver.resize((columns, 40));
        let status = driver.status();
        // Each fact is shown in full.
        let facts = |status: &str| -> Vec<String> {
            status.replace("manual: ", "").replace("  ◆ ", " · ").split(" · ").map(str::to_owned).collect()
        };
        let all = facts(&whole);
        let has_error = all[0].starts_with(&facts(&status)[0]);
        assert!(has_error && facts(&status)[1..].iter().all(|fact| all.contains(fact)), "{status}|{whole}");
    }
}
