"use strict";
(() => {
  const tools = document.getElementById("tools");
  const find = document.getElementById("find");
  const order = document.getElementById("order");
  const found = document.getElementById("found");
  const table = document.querySelector("table");
  const homes = Array.from(table.tBodies);
  const all = table.createTBody();
  all.setAttribute("role", "rowgroup");
  const rows = homes.flatMap((home) =>
    Array.from(home.rows).slice(1).map((row) => ({
      row, home, text: row.textContent.toLowerCase(), place: Number(row.dataset.order),
      confidence: row.dataset.confidence === "" ? -1 : Number(row.dataset.confidence),
    })));

  function search() {
    const words = find.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    for (const item of rows) {
      item.row.hidden = !words.every((word) => item.text.includes(word));
      count += item.row.hidden ? 0 : 1;
    }
    for (const home of homes) {
      home.hidden = order.value !== "need" || !rows.some((item) => item.home === home && !item.row.hidden);
    }
    found.textContent = words.length ? count + " of " + rows.length : "";
  }

  function sort() {
    if (order.value === "need") {
      for (const item of rows) item.home.append(item.row);
    } else {
      const key = order.value === "name" ? "place" : "confidence";
      const sorted = rows.slice().sort((a, b) => a[key] - b[key] || a.place - b.place);
      all.append(...sorted.map((item) => item.row));
    }
    search();
  }

  function restore() {
    if (!location.hash) return;
    order.value = "need";
    find.value = "";
    sort();
  }

  tools.addEventListener("submit", (event) => event.preventDefault());
  find.addEventListener("input", search);
  order.addEventListener("change", sort);
  window.addEventListener("hashchange", restore);
  tools.hidden = false;
  if (find.value || order.value !== "need") sort(); /* kept by the browser on reload */
})();
