//! The input of a complete sequence from the terminal. Unrequested replies are ignored.

use crossterm::event::{
    Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, MouseButton, MouseEvent, MouseEventKind,
};

/// `Esc [`, the parameters and a final letter.
pub(super) fn csi(parameters: &[u8], last: u8) -> Option<Event> {
    let text = str::from_utf8(parameters).ok()?;
    if let Some(report) = text.strip_prefix('<') {
        return sgr_mouse(report, last);
    }
    if text == "[" {
        let number = last.checked_sub(b'A').filter(|&number| number < 5)?;
        return Some(Event::Key(KeyCode::F(1 + number).into()));
    }
    let is_plain = |letter: char| letter.is_ascii_digit() || ";:".contains(letter);
    if !text.chars().all(is_plain) {
        return None;
    }
    let parts: Vec<&str> = text.split(';').collect();
    match last {
        b'M' => rxvt_mouse(&parts),
        b'u' => key(code_of(parts[0], held(parts.get(1))?.0)?, parts.get(1)),
        b'~' if parts[0] == "27" => {
            key(code_of(parts.get(2)?, held(parts.get(1))?.0)?, parts.get(1))
        }
        b'~' => key((numbered(parts[0])?, KeyModifiers::NONE), parts.get(1)),
        b'Z' => Some(Event::Key(KeyEvent::new(KeyCode::BackTab, KeyModifiers::SHIFT))),
        // The position of the cursor.
        b'R' => None,
        _ => lettered(&parts, last),
    }
}

/// `Esc O`, the parameters and a final letter.
pub(super) fn ss3(parameters: &[u8], last: u8) -> Option<Event> {
    let text = str::from_utf8(parameters).ok()?;
    lettered(&text.split(';').collect::<Vec<_>>(), last)
}

/// `Esc [ M` and three bytes.
pub(super) fn mouse(button: u8, column: u8, row: u8) -> Option<Event> {
    let place = |byte: u8| byte.checked_sub(33).map(u16::from);
    at(button.checked_sub(32)?, place(column)?, place(row)?)
}

fn lettered(parts: &[&str], last: u8) -> Option<Event> {
    let code = match last {
        b'A' => KeyCode::Up,
        b'B' => KeyCode::Down,
        b'C' => KeyCode::Right,
        b'D' => KeyCode::Left,
        b'F' => KeyCode::End,
        b'H' => KeyCode::Home,
        b'P'..=b'S' => KeyCode::F(1 + last - b'P'),
        _ => return None,
    };
    // Old terminals omit the first parameter, which is 1.
    let held = parts.get(1).or(parts.first().filter(|part| !part.is_empty()));
    key((code, KeyModifiers::NONE), held)
}

fn numbered(number: &str) -> Option<KeyCode> {
    Some(match number.parse::<u8>().ok()? {
        1 | 7 => KeyCode::Home,
        2 => KeyCode::Insert,
        3 => KeyCode::Delete,
        4 | 8 => KeyCode::End,
        5 => KeyCode::PageUp,
        6 => KeyCode::PageDown,
        number @ 11..=15 => KeyCode::F(number - 10),
        number @ 17..=21 => KeyCode::F(number - 11),
        number @ 23..=26 => KeyCode::F(number - 12),
        number @ 28..=29 => KeyCode::F(number - 13),
        number @ 31..=34 => KeyCode::F(number - 14),
        _ => return None,
    })
}

/// A key from its number in Unicode or in the kitty protocol, and the modifiers that its character
/// already includes.
fn code_of(number: &str, held: KeyModifiers) -> Option<(KeyCode, KeyModifiers)> {
    let mut numbers = number.split(':').map(|number| number.parse::<u32>().ok());
    let code = match numbers.next()?? {
        0x1b => KeyCode::Esc,
        0x0d => KeyCode::Enter,
        0x09 if held.contains(KeyModifiers::SHIFT) => KeyCode::BackTab,
        0x09 => KeyCode::Tab,
        0x7f => KeyCode::Backspace,
        number @ 57376..=57398 => KeyCode::F(u8::try_from(number - 57376 + 13).ok()?),
        number @ 57399..=57427 => keypad(number - 57399)?,
        57344..=63743 => return None,
        number => KeyCode::Char(char::from_u32(number)?),
    };
    let shifted = numbers.next().flatten().and_then(char::from_u32);
    Some(match shifted {
        Some(letter) if held.contains(KeyModifiers::SHIFT) => {
            (KeyCode::Char(letter), KeyModifiers::SHIFT)
        }
        _ => (code, KeyModifiers::NONE),
    })
}

fn keypad(number: u32) -> Option<KeyCode> {
    use KeyCode::{Delete, Down, End, Enter, Home, Insert, Left, PageDown, PageUp, Right, Up};
    const MOVES: [KeyCode; 10] =
        [Left, Right, Up, Down, PageUp, PageDown, Home, End, Insert, Delete];
    let number = usize::try_from(number).ok()?;
    match number {
        15 => Some(Enter),
        18.. => MOVES.get(number - 18).copied(),
        _ => "0123456789./*-+\n=,".chars().nth(number).map(KeyCode::Char),
    }
}

/// A key with the modifiers of a parameter, without those that its character already includes.
fn key((code, shown): (KeyCode, KeyModifiers), parameter: Option<&&str>) -> Option<Event> {
    let (modifiers, kind) = held(parameter)?;
    let key = KeyEvent::new_with_kind(code, modifiers - shown, kind);
    Some(Event::Key(key))
}

/// Parses `modifiers:kind`, where modifiers are bits plus one. Locks are ignored.
fn held(parameter: Option<&&str>) -> Option<(KeyModifiers, KeyEventKind)> {
    const BITS: [KeyModifiers; 6] = [
        KeyModifiers::SHIFT,
        KeyModifiers::ALT,
        KeyModifiers::CONTROL,
        KeyModifiers::SUPER,
        KeyModifiers::HYPER,
        KeyModifiers::META,
    ];
    let mut parts = parameter.copied().unwrap_or_default().split(':');
    let mask = match parts.next() {
        None | Some("") => 0,
        Some(mask) => mask.parse::<u8>().ok()?.saturating_sub(1),
    };
    let kind = match parts.next() {
        Some("2") => KeyEventKind::Repeat,
        Some("3") => KeyEventKind::Release,
        _ => KeyEventKind::Press,
    };
    let bits = BITS.iter().enumerate();
    let held = bits.filter(|(bit, _)| mask & (1 << bit) != 0);
    Some((held.map(|(_, &modifier)| modifier).collect(), kind))
}

fn rxvt_mouse(parts: &[&str]) -> Option<Event> {
    let (button, column, row) = report(parts)?;
    at(button.checked_sub(32)?, column, row)
}

fn sgr_mouse(text: &str, last: u8) -> Option<Event> {
    let (button, column, row) = report(&text.split(';').collect::<Vec<_>>())?;
    let event = at(button, column, row)?;
    match (last, event) {
        (b'M', event) => Some(event),
        (b'm', Event::Mouse(mouse)) => {
            let kind = match mouse.kind {
                MouseEventKind::Down(button) => MouseEventKind::Up(button),
                kind => kind,
            };
            Some(Event::Mouse(MouseEvent { kind, ..mouse }))
        }
        _ => None,
    }
}

/// Button, column and row; the first column is 1 in the report and 0 here.
fn report(parts: &[&str]) -> Option<(u8, u16, u16)> {
    let place = |part: &str| part.parse::<u16>().ok()?.checked_sub(1);
    let [button, column, row, ..] = parts else {
        return None;
    };
    Some((button.parse().ok()?, place(column)?, place(row)?))
}

/// Bits of `button` from the lowest: button (2), Shift, Alt, Ctrl, motion, button (2).
fn at(button: u8, column: u16, row: u16) -> Option<Event> {
    const BITS: [(u8, KeyModifiers); 3] =
        [(4, KeyModifiers::SHIFT), (8, KeyModifiers::ALT), (16, KeyModifiers::CONTROL)];
    let number = (button & 0b11) | ((button & 0b1100_0000) >> 4);
    let moves = button & 0b10_0000 != 0;
    let of = [MouseButton::Left, MouseButton::Middle, MouseButton::Right];
    let kind = match (number, moves) {
        (0..=2, false) => MouseEventKind::Down(of[usize::from(number)]),
        (0..=2, true) => MouseEventKind::Drag(of[usize::from(number)]),
        (3, false) => MouseEventKind::Up(MouseButton::Left),
        (3..=5, true) => MouseEventKind::Moved,
        (4, false) => MouseEventKind::ScrollUp,
        (5, false) => MouseEventKind::ScrollDown,
        (6, false) => MouseEventKind::ScrollLeft,
        (7, false) => MouseEventKind::ScrollRight,
        _ => return None,
    };
    let held = BITS.iter().filter(|(bit, _)| button & bit != 0);
    Some(Event::Mouse(MouseEvent {
        kind,
        column,
        row,
        modifiers: held.map(|&(_, modifier)| modifier).collect(),
    }))
}
