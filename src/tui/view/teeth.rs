//! The teeth at the driver's roll angle.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::{text, titled};
use crate::tui::app::App;
use crate::tui::pane::Pane;

/// Draw the pane.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let inner = titled(app, Pane::Teeth, "Teeth", area, buffer);
    let position = app.answer.as_ref().and_then(|answer| answer.of(answer.active)?.position);
    let words = match position {
        Some(position) => format!(
            "The driven tip touches the driver's flank {:.4} deg of the driver before E, at {:.4} mm from its axis.",
            position.approach_angle_driver.to_degrees(),
            1e3 * position.contact.radius_driver
        ),
        None => "The teeth meet at E, where the normal path of contact begins.".to_owned(),
    };
    let width = inner.width.saturating_sub(2).into();
    for (line, y) in text::wrap(&words, width).iter().zip(inner.top()..inner.bottom()) {
        buffer.set_stringn(inner.x + 1, y, line, width, Style::new());
    }
}
