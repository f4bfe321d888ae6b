// Sorts tables, filters by material, reads charts out. The page is complete without it.
(() => {
  "use strict";
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];

  // Tables: a click on a head sorts by its column, a second one the other way round.
  const value = cell => {
    if (!cell) return "";
    if (cell.dataset.v !== undefined) return Number(cell.dataset.v);
    const text = (cell.firstChild ? cell.firstChild.textContent : "").trim();
    if (text === "not finite") return Infinity;
    const number = Number.parseFloat(text);
    return Number.isNaN(number) ? text : number;
  };
  const order = (a, b) => {
    if (typeof a === typeof b) return typeof a === "number" ? a - b : a.localeCompare(b);
    return typeof a === "number" ? -1 : 1;
  };
  for (const table of all("table.sortable")) {
    const heads = all("thead th", table);
    const sort = column => {
      const up = heads[column].getAttribute("aria-sort") !== "ascending";
      heads.forEach(head => head.removeAttribute("aria-sort"));
      heads[column].setAttribute("aria-sort", up ? "ascending" : "descending");
      const body = table.tBodies[0];
      const rows = [...body.rows].map(row => [value(row.cells[column]), row]);
      rows.sort((a, b) => (up ? order(a[0], b[0]) : order(b[0], a[0])));
      body.append(...rows.map(row => row[1]));
    };
    heads.forEach((head, column) => {
      head.tabIndex = 0;
      head.addEventListener("click", () => sort(column));
      head.addEventListener("keydown", event => {
        if (event.key === "Enter" || event.key === " ") {
          event.preventDefault();
          sort(column);
        }
      });
    });
  }

  // The filter: what belongs to a material whose name lacks the text is hidden.
  const label = document.getElementById("filter");
  const input = label.querySelector("input");
  label.hidden = false;
  input.addEventListener("input", () => {
    const text = input.value.trim().toLowerCase();
    for (const element of all("[data-material]")) {
      element.classList.toggle("filtered", !element.dataset.material.toLowerCase().includes(text));
    }
  });

  // Charts: the tip says what is under the pointer.
  const tip = document.createElement("div");
  tip.id = "tip";
  tip.hidden = true;
  document.body.append(tip);
  const show = ({ clientX, clientY }, text) => {
    tip.textContent = text;
    tip.hidden = false;
    tip.style.left = Math.max(8, Math.min(clientX + 14, innerWidth - tip.offsetWidth - 8)) + "px";
    tip.style.top = Math.min(clientY + 14, innerHeight - tip.offsetHeight - 8) + "px";
  };
  // Browsers show titles late and beside the tip.
  for (const title of all("svg title")) {
    const owner = title.parentNode;
    owner.dataset.tip = title.textContent;
    owner.setAttribute("aria-label", title.textContent);
    title.remove();
  }
  const scale = text => {
    const [kind, min, max, from, to] = text.split(" ").map((word, i) => (i ? Number(word) : word));
    return pixel => {
      const value = min + ((pixel - from) / (to - from)) * (max - min);
      return kind === "log" ? 10 ** value : value;
    };
  };
  const REACH = 30;
  for (const chart of all("svg.chart[data-x]")) {
    const [x, y] = [scale(chart.dataset.x), scale(chart.dataset.y)];
    let points = null;
    const read = () =>
      all("path[data-name]", chart).flatMap(path =>
        path
          .getAttribute("d")
          .split(/(?=[ML])/)
          .map(piece => [...piece.slice(1).split(" ").map(Number), path.dataset.name])
      );
    chart.addEventListener("pointermove", event => {
      const marked = event.target.closest("[data-tip]");
      if (marked) return show(event, marked.dataset.tip);
      points = points || read();
      const box = chart.getBoundingClientRect();
      const unit = chart.viewBox.baseVal.width / box.width;
      const at = [(event.clientX - box.left) * unit, (event.clientY - box.top) * unit];
      let near = null;
      let least = REACH;
      for (const point of points) {
        const distance = Math.hypot(point[0] - at[0], point[1] - at[1]);
        if (distance < least) [near, least] = [point, distance];
      }
      if (!near) return void (tip.hidden = true);
      const words = number => Number(number.toPrecision(3)).toString();
      show(event, `${near[2]}: ${words(y(near[1]))} at ${words(x(near[0]))}`);
    });
    chart.addEventListener("pointerleave", () => (tip.hidden = true));
  }
  for (const map of all("svg.stability, .thumbs")) {
    map.addEventListener("pointermove", event => {
      const marked = event.target.closest("[data-tip]");
      if (marked) show(event, marked.dataset.tip);
      else tip.hidden = true;
    });
    map.addEventListener("pointerleave", () => (tip.hidden = true));
  }
  // What the keyboard has reached says as much as what the pointer is over.
  document.addEventListener("focusin", event => {
    const marked = event.target.closest("svg a, .thumbs a");
    const owner = marked && (marked.querySelector("[data-tip]") || marked);
    if (!owner) return void (tip.hidden = true);
    const box = marked.getBoundingClientRect();
    show({ clientX: box.right, clientY: box.bottom }, owner.dataset.tip);
  });

  // Links lead to what may be folded.
  const unfold = hash => {
    const target = hash && document.getElementById(hash.slice(1));
    if (!target) return;
    for (let at = target; at; at = at.parentElement) if (at.tagName === "DETAILS") at.open = true;
    target.scrollIntoView();
  };
  addEventListener("hashchange", () => unfold(location.hash));
  // A second click on a link changes nothing in the address.
  for (const link of all("a[href^='#']")) link.addEventListener("click", () => unfold(link.getAttribute("href")));
  unfold(location.hash);

  // Paper has nothing to click on.
  let opened = [];
  addEventListener("beforeprint", () => {
    opened = all("details:not([open])");
    opened.forEach(details => (details.open = true));
  });
  addEventListener("afterprint", () => opened.forEach(details => (details.open = false)));
})();
