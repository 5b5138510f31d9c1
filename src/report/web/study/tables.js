// The tables of a study: lists "a / b / c" as columns of their own, numbers aligned, the least of each column marked.

import { element } from "../shared/elements.js";

export const list_of = (cell) => cell.split(" / ");
export const cell_text = (text) => text.replace(/(^|e|\s|\()-(?=[\d.])/g, "$1−");

/// A column of the table as shown: one of the study's, or the entries at one place of its lists.
/// `heading` and `span` are there on the first of a group; `text_of(row)` gives a cell.
export function columns_of_table({ title, columns, rows }) {
    // Name the entries of lists after the list in the title, where that has as many: "... at N = 16 / 64 / 256".
    const names = list_of(/\S+ = (\S+(?: \/ \S+)+)/.exec(title)?.[1] ?? "");
    return columns.flatMap((heading, k) => {
        const lengths = new Set(rows.map((row) => list_of(row[k] ?? "").length));
        const count = lengths.size === 1 ? [...lengths][0] : 1;
        return Array.from({ length: count }, (_, i) => ({
            ...(i === 0 ? { heading, span: count } : {}),
            name: count > 1 ? (names.length === count ? names[i] : String(i + 1)) : null,
            text_of: (row) => (count > 1 ? list_of(row[k])[i] : (row[k] ?? "")),
        }));
    });
}

/// True if every cell of the column starts with a number, or is empty or a dash.
export const is_numeric = (column, rows) =>
    rows.every((row) => /^(|[-–]|[-+]?(\d|\.\d|inf|nan).*)$/i.test(column.text_of(row)));

/// The rows with the column's least number, unless so many share it that it says nothing.
export function least_rows(column, rows) {
    const value = (row) => Number.parseFloat(column.text_of(row));
    const least = Math.min(...rows.map(value).filter(Number.isFinite));
    const winners = rows.filter((row) => value(row) === least);
    return winners.length <= Math.max(1, rows.length / 4) ? winners : [];
}

/// True for tables of errors, where the least figure is the best.
export const holds_errors = ({ title, rows }) => rows.length > 2 && /\b(error|excess)/i.test(title);

export function table_head(columns) {
    const with_names = columns.some(({ name }) => name);
    const groups = columns
        .filter(({ heading }) => heading !== undefined)
        .map(({ heading, span, name, numeric }, k) =>
            element(
                "th",
                {
                    scope: name ? "colgroup" : "col",
                    colspan: span,
                    rowspan: with_names && !name ? 2 : 1,
                    class: k === 0 ? "first" : name ? "group" : numeric ? "number" : null,
                },
                heading,
            ),
        );
    const names = columns
        .filter(({ name }) => name)
        .map(({ name, heading }) =>
            element(heading === undefined ? "th.number" : "th.number.group", { scope: "col" }, name),
        );
    return element("thead", element("tr", ...groups), with_names ? element("tr", ...names) : null);
}

export function table_row(row, columns, winners) {
    return element(
        "tr",
        ...columns.map((column, k) => {
            const text = cell_text(column.text_of(row));
            if (k === 0) return element("th.first", { scope: "row" }, text);
            const cell = element("td", text);
            cell.classList.toggle("number", column.numeric);
            cell.classList.toggle("listed", Boolean(column.name));
            cell.classList.toggle("group", Boolean(column.name) && column.heading !== undefined);
            cell.classList.toggle("best", winners[k].includes(row));
            return cell;
        }),
    );
}

export function study_table(table) {
    const columns = columns_of_table(table);
    for (const column of columns) column.numeric = is_numeric(column, table.rows);
    const marks_least = holds_errors(table);
    const winners = columns.map((column, k) =>
        marks_least && k > 0 && column.numeric ? least_rows(column, table.rows) : [],
    );
    const note = [table.note, winners.some((rows) => rows.length) && "The least of each column is in blue."];
    return element(
        "figure.study-table",
        element("figcaption", element("h3", table.title), element("p.muted", note.filter(Boolean).join(" "))),
        element(
            "div.table-scroll",
            { tabindex: 0, role: "region", "aria-label": table.title },
            element(
                "table.values",
                table_head(columns),
                element("tbody", ...table.rows.map((row) => table_row(row, columns, winners))),
            ),
        ),
    );
}
