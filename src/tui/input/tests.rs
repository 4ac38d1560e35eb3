//! Tests of the decoder: every known sequence, in one piece, in parts, and unfinished.

use super::Input as Event;
use super::*;
use crossterm::event::{MouseButton, MouseEvent, MouseEventKind};

const NONE: KeyModifiers = KeyModifiers::NONE;
const SHIFT: KeyModifiers = KeyModifiers::SHIFT;
const ALT: KeyModifiers = KeyModifiers::ALT;
const CTRL: KeyModifiers = KeyModifiers::CONTROL;

/// The inputs of consecutive reads, and the inputs after a timeout.
fn decode(reads: &[&[u8]]) -> (Vec<Event>, Vec<Event>) {
    let (mut decoder, mut inputs, mut rest) = (Decoder::default(), Vec::new(), Vec::new());
    for read in reads {
        decoder.feed(read, false, &mut inputs);
    }
    if decoder.patience().is_some() {
        decoder.expire(&mut rest);
    }
    assert_eq!(decoder.patience(), None, "silence ends everything");
    (inputs, rest)
}

fn key(code: KeyCode, modifiers: KeyModifiers) -> Event {
    Event::Key(KeyEvent::new(code, modifiers))
}

fn keys(text: &str) -> Vec<Event> {
    text.chars().map(|letter| of_letter(letter, NONE)).collect()
}

#[test]
fn every_key_is_decoded_with_its_modifiers() {
    use KeyCode::{
        BackTab, Backspace, Char, Delete, Down, End, Enter, Esc, F, Home, Insert, Left, PageDown,
        PageUp, Right, Tab, Up,
    };
    let rows: [(&[u8], KeyCode, KeyModifiers); 57] = [
        (b"a", Char('a'), NONE),
        (b"A", Char('A'), NONE),
        ("\u{6b6f}".as_bytes(), Char('\u{6b6f}'), NONE),
        (b"\r", Enter, NONE),
        (b"\n", Char('j'), CTRL),
        (b"\t", Tab, NONE),
        (b"\x7f", Backspace, NONE),
        (b"\x08", Char('h'), CTRL),
        (b"\0", Char(' '), CTRL),
        (b"\x11", Char('q'), CTRL),
        (b"\x1c", Char('4'), CTRL),
        (b"\x1bz", Char('z'), ALT),
        (b"\x1bZ", Char('Z'), ALT),
        (b"\x1b1", Char('1'), ALT),
        (b"\x1b\r", Enter, ALT),
        (b"\x1b\x7f", Backspace, ALT),
        (b"\x1b\x11", Char('q'), ALT.union(CTRL)),
        ("\x1b\u{f6}".as_bytes(), Char('\u{f6}'), ALT),
        (b"\x1b[A", Up, NONE),
        (b"\x1b[B", Down, NONE),
        (b"\x1b[C", Right, NONE),
        (b"\x1b[D", Left, NONE),
        (b"\x1b[H", Home, NONE),
        (b"\x1b[F", End, NONE),
        (b"\x1b[Z", BackTab, SHIFT),
        (b"\x1bOA", Up, NONE),
        (b"\x1bOD", Left, NONE),
        (b"\x1bOH", Home, NONE),
        (b"\x1bOF", End, NONE),
        (b"\x1bOP", F(1), NONE),
        (b"\x1bOS", F(4), NONE),
        (b"\x1bO5P", F(1), CTRL),
        (b"\x1b[P", F(1), NONE),
        (b"\x1b[[A", F(1), NONE),
        (b"\x1b[[E", F(5), NONE),
        (b"\x1b[1;5A", Up, CTRL),
        (b"\x1b[1;2B", Down, SHIFT),
        (b"\x1b[1;3C", Right, ALT),
        (b"\x1b[1;6D", Left, CTRL.union(SHIFT)),
        (b"\x1b[1;5H", Home, CTRL),
        (b"\x1b[5D", Left, CTRL),
        (b"\x1b[1~", Home, NONE),
        (b"\x1b[2~", Insert, NONE),
        (b"\x1b[3~", Delete, NONE),
        (b"\x1b[3;5~", Delete, CTRL),
        (b"\x1b[4~", End, NONE),
        (b"\x1b[5~", PageUp, NONE),
        (b"\x1b[6~", PageDown, NONE),
        (b"\x1b[6;5~", PageDown, CTRL),
        (b"\x1b[15~", F(5), NONE),
        (b"\x1b[17~", F(6), NONE),
        (b"\x1b[24;2~", F(12), SHIFT),
        (b"\x1b[97;5u", Char('a'), CTRL),
        (b"\x1b[27u", Esc, NONE),
        (b"\x1b[13;5u", Enter, CTRL),
        (b"\x1b[9;2u", BackTab, SHIFT),
        (b"\x1b[27;5;113~", Char('q'), CTRL),
    ];
    for (bytes, code, modifiers) in rows {
        let expected = (vec![key(code, modifiers)], vec![]);
        assert_eq!(decode(&[bytes]), expected, "{:?}", bytes.escape_ascii());
    }
    assert_eq!(decode(&[b"\x1b[97;1:3u"]).0, [], "a released key is not pressed");
}

#[test]
fn the_three_kinds_of_mouse_reports_are_decoded() {
    let mouse = |kind, column, row| Event::Mouse(MouseEvent { kind, column, row, modifiers: NONE });
    let left = MouseEventKind::Down(MouseButton::Left);
    let rows: [(&[u8], Event); 5] = [
        (b"\x1b[<0;20;8M", mouse(left, 19, 7)),
        (b"\x1b[<16;1;1M", mouse(left, 0, 0)),
        (b"\x1b[<65;300;2M", mouse(MouseEventKind::ScrollDown, 299, 1)),
        (b"\x1b[32;30;40M", mouse(left, 29, 39)),
        (b"\x1b[M \x21\xff", mouse(left, 0, 222)),
    ];
    for (bytes, event) in rows {
        assert_eq!(decode(&[bytes]).0, [event], "{:?}", bytes.escape_ascii());
    }
    for unused in [&b"\x1b[<0;20;8m"[..], b"\x1b[<35;9;9M", b"\x1b[<2;9;9M"] {
        assert_eq!(decode(&[unused, b"x"]).0, keys("x"));
    }
    for outside in [&b"\x1b[<0;0;0M"[..], b"\x1b[32;0;0M", b"\x1b[M   "] {
        assert_eq!(decode(&[outside, b"x"]).0, keys("x"));
    }
}

#[test]
fn replies_that_nobody_asked_for_press_no_key() {
    for reply in [
        &b"\x1b[?2026;2$y"[..],
        b"\x1b[?1;2c",
        b"\x1b[>41;354;0c",
        b"\x1b[?1u",
        b"\x1b[5;5R",
        b"\x1b[I",
        b"\x1b[O",
        b"\x1b[99999999999999999999~",
        b"\x1b[1;99999999A",
        b"\x1b[57441u",
        b"\x1b[201~",
        b"\x1b]11;rgb:0000/0000/0000\x07",
        b"\x1b]11;rgb:0000/0000/0000\x1b\\",
        b"\x1bP1$r0m\x1b\\",
        b"\xff\xfe",
        b"\xc3\x28".split_at(1).0,
    ] {
        let (inputs, rest) = decode(&[reply, b"x"]);
        assert_eq!(inputs, keys("x"), "{:?}", reply.escape_ascii());
        assert!(rest.is_empty());
    }
}

#[test]
fn an_unfinished_sequence_does_not_delay_later_keys() {
    for start in [
        &b"\x1b[<"[..],
        b"\x1b[1;",
        b"\x1b[?",
        b"\x1b[1111",
        b"\x1b[M ",
        b"\x1bO1",
        b"\x1b]0;",
        b"\x1bP",
        b"\xc3",
        b"\xf0\x9f",
    ] {
        let (_, rest) = decode(&[start]);
        let is_key = rest == [key(KeyCode::Char('P'), ALT)];
        assert!(rest.is_empty() || is_key, "{:?}", start.escape_ascii());
        let (inputs, _) = decode(&[start, b"\x1b[B"]);
        assert_eq!(inputs, [key(KeyCode::Down, NONE)]);
        let (inputs, _) = decode(&[start, b"\x11"]);
        assert_eq!(inputs.last(), Some(&key(KeyCode::Char('q'), CTRL)));
    }
    let endless = [b"\x1b[".to_vec(), b"1".repeat(LONGEST_SEQUENCE + 3)].concat();
    assert_eq!(decode(&[&endless]).0, keys("11"));
}

#[test]
fn escape_is_a_key_unless_a_sequence_follows() {
    let esc = || key(KeyCode::Esc, NONE);
    assert_eq!(decode(&[b"\x1b"]), (vec![], vec![esc()]));
    assert_eq!(decode(&[b"\x1b\x1b"]), (vec![esc()], vec![esc()]));
    let up = || key(KeyCode::Up, NONE);
    assert_eq!(decode(&[b"\x1b", b"[", b"A"]).0, [up()]);
    assert_eq!(decode(&[b"\x1b\x1b[A"]).0, [esc(), up()]);
    let apart = [esc(), key(KeyCode::Char('x'), NONE)];
    assert_eq!(decode(&[b"\x1b", b"x"]).0, apart);
    assert_eq!(decode(&[b"\x1b["]).1, [key(KeyCode::Char('['), ALT)]);
}

#[test]
fn the_rest_of_a_sequence_has_a_tenth_of_a_second_however_many_bytes_come() {
    let (mut decoder, mut inputs) = (Decoder::default(), Vec::new());
    decoder.feed(b"\x1b[1", false, &mut inputs);
    for _ in 0..3 {
        decoder.has_waited(SEQUENCE / 4);
        decoder.feed(b"1", false, &mut inputs);
    }
    assert_eq!(decoder.patience(), Some(SEQUENCE / 4));
    decoder.feed(b"A\x1b[1", false, &mut inputs);
    assert_eq!(decoder.patience(), Some(SEQUENCE));
}

#[test]
fn a_paste_ends_with_its_mark_with_silence_or_with_a_lone_escape() {
    let paste = |text: &str| vec![Event::Paste(text.to_owned())];
    let mixed = b"\x1b[200~a\x1b[31m\x1b\x1b[20\r\x11\x1b[201~";
    let text = "a\x1b[31m\x1b\x1b[20\r\x11";
    assert_eq!(decode(&[mixed]), (paste(text), vec![]));
    let pieces = mixed.chunks(1).collect::<Vec<_>>();
    assert_eq!(decode(&pieces), (paste(text), vec![]));
    assert_eq!(decode(&[b"\x1b[200~abc"]), (vec![], paste("abc")));
    assert_eq!(decode(&[b"\x1b[200~abc\x1b"]), (vec![], paste("abc")));
    let (mut decoder, mut inputs) = (Decoder::default(), Vec::new());
    for (bytes, patience) in [(&b"\x1b[200~a"[..], PASTE), (b"\x1b", SEQUENCE), (b"[20", PASTE)] {
        decoder.feed(bytes, false, &mut inputs);
        assert_eq!(decoder.patience(), Some(patience));
    }
    let long = b"dscyn".repeat(LONGEST_PASTE / 4);
    let (inputs, _) = decode(&[b"\x1b[200~", &long, b"\x1b[201~x"]);
    assert_eq!(inputs[1..], keys("x"));
    assert!(matches!(&inputs[0], Event::Paste(text) if text.len() == LONGEST_PASTE));
}

#[test]
fn a_control_key_after_a_pause_ends_a_paste_without_an_end() {
    let after = |pause: Duration, bytes: &[u8]| {
        let (mut decoder, mut inputs) = (Decoder::default(), Vec::new());
        decoder.feed(b"\x1b[200~abc", false, &mut inputs);
        decoder.has_waited(pause);
        decoder.feed(bytes, false, &mut inputs);
        inputs
    };
    let ctrl_q = key(KeyCode::Char('q'), CTRL);
    let ended = vec![Event::Paste("abc".to_owned()), ctrl_q];
    assert_eq!(after(SEQUENCE, b"\x11"), ended);
    for (pause, bytes) in [
        (Duration::ZERO, &b"\x11"[..]),
        (SEQUENCE, b"d"),
        (SEQUENCE, b"\r"),
        (SEQUENCE, b"x\x11"),
        (SEQUENCE, b"\x1b"),
    ] {
        assert_eq!(after(pause, bytes), [], "{pause:?} {bytes:?}");
    }
}

fn events(text: &str) -> Vec<super::Event> {
    keys(text).into_iter().map(super::Event::Input).collect()
}

#[test]
fn a_run_of_letters_becomes_one_action() {
    let mut inputs = events("16 um").into_iter().peekable();
    let action = take_action(&mut inputs, Place::TEXT);
    assert!(matches!(action, Some(Action::Paste(text)) if text == "16 um"));
    let mut inputs = events("sd").into_iter().peekable();
    assert!(matches!(take_action(&mut inputs, Place::ASK), Some(Action::Insert('s'))));
}
