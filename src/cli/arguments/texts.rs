//! The text of a command's help after its options.

pub(super) const CSV_SHAPE: &str = "CSV: one row per case and one column per quantity in SI units, such as `impact_force [N]`; with --stations \
    one row per station. JSON: one object per case and line, in SI units; missing values are absent.";

pub(super) const CHECK_SHAPE: &str = "A limit on impact_force applies to the free impact in every \
    method. With static and dynamic, the verdict also prints the force by the method; a separate \
    limit can be set on that force. Without corner contact every limit on the impact is met. If a \
    quantity has no value, the verdict is `unknown` with the reason, and the exit code is 1. \
    JSON: one object per verdict, in SI units.";

pub(super) const TRADE_SHAPE: &str = "Each setting is timed on this machine. Its total error is the greatest relative difference of first contact, \
    forces and curve from the finest setting of method dynamic. The model error is that of the finest setting of the same method; \
    the rest is numerical. Where no method finds corner contact, no setting is recommended. JSON is one object in SI units; missing \
    values are absent.";

pub(super) const STIFFNESS_SHAPE: &str = "The finite elements are plane strain on the whole gear, as in tooth_compliance = \"finite-element\". CSV: one row \
    per gear and radius, in SI units; a cell is empty where a model does not cover the gear. JSON: one object in SI units; missing \
    values are absent, and gaps and refusal give the reason.";

pub(super) const PLOT_SHAPE: &str = "The chart shows the method of the case. If the method has no \
    such chart, the command draws another method: load_share of paper and exact shows static; \
    impact_energy of static and dynamic shows exact. The legend names the method. The chart speed \
    shows method dynamic at the torque of the case, with the speed rising and falling. The \
    picture follows the light or dark setting of the browser.";

pub(super) const REPORT_SHAPE: &str = "The HTML page is complete in itself: verdict, inputs, results, charts, teeth, limits, notes and the case \
    files; one case prints on two A4 pages. Markdown has the same without charts. CSV and JSON are those of `solve`, JSON with the \
    stations.";

pub(super) const IMPORT_SHAPE: &str = "REXS is the exchange format of gear programs such as FVA-Workbench and Bearinx. Versions 1.0 to 2.0 \
    are read. Each value of the case has its source as a comment; standard error lists the stages of the model and each field \
    that stays empty, with the reason. Helical, planetary, bevel and other stages are refused.";
