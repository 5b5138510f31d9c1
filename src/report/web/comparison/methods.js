// The table of all methods: sorted, filtered, moved through by keys.

import { button, by_id, element, segment_choice, select_element } from "../shared/elements.js";
import { capitalised, count_text, figure_text, share_text } from "../shared/format.js";
import { compare_values } from "../shared/sorting.js";
import { domains, mean, method_by_name, methods, report } from "./data.js";
import { detail, open_detail } from "./detail.js";
import { best_of_bases, name_matches, relative_error, winners_of } from "./ranking.js";
import { is_pinned, toggle_pin } from "./selection.js";

/// Columns under a common heading. `best`: the least value is worth a mark. `extra`: hidden until asked for.
function column_group(group, common, columns) {
    return columns.map((column) => ({ group, ...common, ...column }));
}

const method_columns = [
    ...column_group("Method", { text: true }, [
        { key: "basis", title: "Basis" },
        { key: "encoder", title: "Encoder" },
        { key: "evaluator", title: "Evaluator" },
        { key: "domain", title: "Domain", absent: domains.length < 2 },
    ]),
    ...column_group("Size", { show: count_text }, [
        { key: "floats", title: "Floats" },
        { key: "bytes", title: "Bytes" },
    ]),
    ...column_group("Irradiance E/π, error", { best: true }, [
        { key: "irradiance_percent", title: "% of mean", value: (method) => relative_error(method, "irradiance", mean), show: share_text, hint: "RMS error over the mean" },
        { key: "irradiance_over_pi_rms", title: "RMS", hint: "W/(m² sr)" },
        { key: "irradiance_over_pi_rms_unweighted", title: "RMS unw.", extra: true, hint: "Every texel counts alike" },
        { key: "irradiance_smape", title: "sMAPE" },
        { key: "irradiance_relmse", title: "relMSE" },
        { key: "worst", title: "Largest", value: (method) => method.irradiance_worst?.error },
    ]),
    ...column_group("Radiance L, error", { best: true }, [
        { key: "radiance_percent", title: "% of mean", value: (method) => relative_error(method, "radiance", mean), show: share_text, hint: "RMS error over the mean" },
        { key: "radiance_rms", title: "RMS", hint: "W/(m² sr)" },
        { key: "radiance_rms_unweighted", title: "RMS unw.", extra: true, hint: "Every texel counts alike" },
        { key: "radiance_smape", title: "sMAPE" },
        { key: "radiance_relmse", title: "relMSE" },
        { key: "negative_share", title: "Negative %", show: share_text, hint: "Directions of negative radiance" },
    ]),
    ...column_group("Time", { best: true }, [
        { key: "encode_ms", title: "Encode ms" },
        { key: "evaluate_ns_per_normal", title: "Evaluate ns", hint: "For one normal" },
    ]),
].filter((column) => !column.absent);

const method_table = {
    sort: methods.length > 12 ? "irradiance_over_pi_rms" : null, // a short list keeps its order
    descending: false,
    per_basis: best_of_bases(methods).length < methods.length && methods.length > 12, // the best method of each only
    filter: { basis: "", encoder: "", evaluator: "", domain: "", text: "" },
    extra: Boolean(report.settings?.recipe), // recipes were published with it
    rows: new Map(), // method -> its row
};

const value_of = (method, column) => (column.value ? column.value(method) : method[column.key]);
const shown_columns = () => method_columns.filter((column) => method_table.extra || !column.extra);

// ---- Filters

export function build_filters() {
    const { filter } = method_table;
    const form = by_id("filters");
    const select_of = (key) => {
        const values = [...new Set(methods.map((method) => method[key]))].sort((a, b) =>
            a.localeCompare(b, "en", { numeric: true }),
        );
        if (values.length < 2) return null;
        const options = [["", "all"], ...values.map((value) => [value, value])];
        const choose = (value) => {
            filter[key] = value;
            fill_method_table();
        };
        return element("label", capitalised(key), select_element(options, "", choose));
    };
    const text = element("input", {
        type: "search",
        placeholder: "sg least …",
        spellcheck: "false",
        oninput: (event) => {
            filter.text = event.target.value;
            fill_method_table();
        },
    });
    const extra = element("input", {
        type: "checkbox",
        checked: method_table.extra,
        onchange: (event) => {
            method_table.extra = event.target.checked;
            build_method_table();
        },
    });
    const rows = segment_choice(
        "rows",
        [
            ["basis", "Best of each basis"],
            ["all", `All ${count_text(methods.length)} methods`],
        ],
        method_table.per_basis ? "basis" : "all",
        (choice) => {
            method_table.per_basis = choice === "basis";
            fill_method_table();
        },
    );
    const has_choice = best_of_bases(methods).length < methods.length;
    form.append(
        has_choice ? element("fieldset.segments", { id: "rows" }, element("legend.off-screen", "Rows"), ...rows) : "",
        element("label.search", "Name", text),
        ...["basis", "encoder", "evaluator", "domain"].map(select_of).filter(Boolean),
        element("label.check", extra, "Unweighted RMS"),
    );
    form.addEventListener("submit", (event) => event.preventDefault());
}

function passes_filter(method) {
    const { text, ...keys } = method_table.filter;
    return Object.entries(keys).every(([key, value]) => !value || method[key] === value) && name_matches(method.name, text);
}

/// The methods that the table shows: those that pass the filters, of each basis the best one or all.
function methods_shown() {
    const passing = methods.filter(passes_filter);
    return method_table.per_basis ? best_of_bases(passing) : passing;
}

// ---- Rows

export function build_method_table() {
    const columns = shown_columns();
    const table = by_id("methods");
    const groups = [];
    for (const { group } of columns) {
        if (groups.at(-1)?.group === group) ++groups.at(-1).span;
        else groups.push({ group, span: 1 });
    }
    const group_row = element(
        "tr.groups",
        element("td"),
        ...groups.map(({ group, span }) => element("th", { colspan: span, scope: "colgroup" }, group)),
    );
    const head = element(
        "tr",
        element("th", { scope: "col", class: "pin" }, element("span.off-screen", "Pin")),
        ...columns.map(column_heading),
    );
    method_table.rows = new Map(methods.map((method) => [method, method_row(method, columns)]));
    table.replaceChildren(
        element("caption.off-screen", "All methods with their errors"),
        element("thead", group_row, head),
        element("tbody"),
    );
    fill_method_table();
}

function first_of_group(column, columns) {
    const i = columns.indexOf(column);
    return i === 0 || columns[i - 1].group !== column.group;
}

function column_heading(column, i, columns) {
    const sorter = button(
        "",
        {
            title: column.hint,
            onclick: () => {
                method_table.descending = method_table.sort === column.key && !method_table.descending;
                method_table.sort = column.key;
                fill_method_table();
            },
        },
        column.title,
    );
    return element(
        "th",
        {
            scope: "col",
            class: `${column.text ? "text" : ""}${first_of_group(column, columns) ? " group" : ""}`,
            "data-key": column.key,
        },
        sorter,
    );
}

function method_row(method, columns) {
    const pin = button("quiet", {
        tabindex: -1,
        "aria-label": `Pin ${method.name}`,
        title: "Pin to the pictures (P)",
        onclick: (event) => {
            event.stopPropagation();
            toggle_pin(method);
        },
    });
    const cells = columns.map((column) => {
        const value = value_of(method, column),
            text = column.text ? value : (column.show ?? figure_text)(value);
        return element(
            "td",
            {
                class: `${column.text ? "text" : "number"}${first_of_group(column, columns) ? " group" : ""}`,
                "data-key": column.key,
            },
            text,
        );
    });
    return element(
        "tr",
        {
            tabindex: -1,
            "data-name": method.name,
            onclick: (event) => {
                focus_row(event.currentTarget);
                open_detail(method);
            },
        },
        element("td.pin", pin),
        ...cells,
    );
}

/// Sorts, filters and marks the rows; the rows themselves stay.
function fill_method_table() {
    const column = method_columns.find(({ key }) => key === method_table.sort);
    const sign = method_table.descending ? -1 : 1;
    const shown = methods_shown();
    if (column) shown.sort((a, b) => compare_values(value_of(a, column), value_of(b, column), sign));
    const rows = shown.map((method) => method_table.rows.get(method));
    const body = document.querySelector("#methods tbody");
    body.replaceChildren(...rows);
    if (!rows.some((row) => row.tabIndex === 0)) {
        for (const row of method_table.rows.values()) row.tabIndex = -1;
        if (rows.length) rows[0].tabIndex = 0;
    }
    for (const heading of document.querySelectorAll("#methods th[data-key]")) {
        if (heading.dataset.key === method_table.sort)
            heading.setAttribute("aria-sort", method_table.descending ? "descending" : "ascending");
        else heading.removeAttribute("aria-sort");
    }
    mark_best(shown);
    mark_rows();
    by_id("methods-count").textContent = table_count(shown.length);
}

function table_count(shown) {
    const all = count_text(methods.length);
    if (method_table.per_basis) return `${count_text(shown)} bases, each with its best method; ${all} methods in all.`;
    return shown === methods.length ? `${all} methods.` : `${count_text(shown)} of ${all} methods.`;
}

/// Marks the least value of each column among the shown methods of a domain.
function mark_best(shown) {
    for (const cell of document.querySelectorAll("#methods .best")) cell.classList.remove("best");
    for (const domain of domains) {
        const rivals = shown.filter((method) => method.domain === domain);
        for (const column of shown_columns().filter(({ best }) => best)) {
            for (const method of winners_of(rivals, (candidate) => value_of(candidate, column)))
                method_table.rows.get(method).querySelector(`[data-key="${column.key}"]`).classList.add("best");
        }
    }
}

/// Shows which rows are pinned, and which is open.
export function mark_rows() {
    for (const [method, row] of method_table.rows) {
        row.querySelector(".pin button").setAttribute("aria-pressed", String(is_pinned(method)));
        row.classList.toggle("open", detail.method === method);
    }
}

// ---- Keys

function focus_row(row) {
    for (const other of method_table.rows.values()) other.tabIndex = -1;
    row.tabIndex = 0;
    row.focus();
}

export function on_method_key(event) {
    const row = event.target.closest("tbody tr");
    if (!row || event.target !== row || event.ctrlKey || event.metaKey || event.altKey) return;
    const method = method_by_name.get(row.dataset.name);
    const siblings = [...row.parentNode.children];
    const targets = {
        ArrowDown: row.nextSibling,
        ArrowUp: row.previousSibling,
        Home: siblings[0],
        End: siblings.at(-1),
    };
    if (event.key in targets) {
        if (targets[event.key]) focus_row(targets[event.key]);
        if (detail.method && targets[event.key]) open_detail(method_by_name.get(targets[event.key].dataset.name));
    } else if (event.key === "Enter" || event.key === " ") {
        open_detail(method);
    } else if (event.key === "p" || event.key === "P") {
        toggle_pin(method);
    } else {
        return;
    }
    event.preventDefault();
}
