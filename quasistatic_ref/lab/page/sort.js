// Tables are sorted by the column whose heading is clicked, or has the focus when Enter is pressed;
// once more turns the order. Rows without a number in that column stay last.
"use strict";

function key(cell) {
  const text = cell.textContent.trim();
  const number = /^[+-]?(\d[\d,]*\.?\d*(e[+-]?\d+)?)/i.exec(text);
  if (cell.classList.contains("left")) return [0, text];
  return number ? [0, parseFloat(number[0].replaceAll(",", ""))] : [1, text];
}

function compared(a, b) {
  return typeof a === "number" && typeof b === "number"
    ? a - b
    : String(a).localeCompare(String(b), "en", { numeric: true });
}

function sorted(rows, column, sign) {
  const keyed = rows.map((row, place) => [key(row.cells[column]), place, row]);
  keyed.sort(([a, i], [b, j]) => a[0] - b[0] || sign * compared(a[1], b[1]) || i - j);
  return keyed.map((one) => one[2]);
}

function turn(table, column) {
  const heads = [...table.tHead.rows[0].cells];
  const up = heads[column].getAttribute("aria-sort") !== "ascending";
  for (const head of heads) head.removeAttribute("aria-sort");
  heads[column].setAttribute("aria-sort", up ? "ascending" : "descending");
  const body = table.tBodies[0];
  body.append(...sorted([...body.rows], column, up ? 1 : -1));
}

for (const table of document.querySelectorAll("table")) {
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    head.tabIndex = 0;
    head.title = "sort";
    head.addEventListener("click", () => turn(table, column));
    head.addEventListener("keydown", (event) => {
      if (event.key === "Enter") turn(table, column);
    });
  });
}
