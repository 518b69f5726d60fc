// The lists beside the picture. All text goes in as text.

const SHOWN = 100; // entries at a time

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === "class") made.className = value;
    else if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

const words = (name) => name.replaceAll("_", " ");
const byId = (id) => document.getElementById(id);

class Panel {
  constructor(viewer) {
    this.viewer = viewer;
    this.shown = SHOWN;
    this.filter = new Set(page.properties.filter((p) => p.claimed && p.listed).map((p) => p.name));
    this.fillFilters();
    this.fillList();
  }

  get marks() {
    return page.violations.filter((mark) => this.filter.has(mark.property));
  }

  fillFilters() {
    const chips = page.properties.filter((property) => property.listed).map((property) =>
      element(
        "button",
        {
          class: "chip",
          type: "button",
          "aria-pressed": String(this.filter.has(property.name)),
          title: property.claimed ? "claimed" : "not claimed",
          onclick: (event) => this.toggle(property.name, event.currentTarget),
        },
        words(property.name),
        element("span", { class: "count" }, property.total),
      ),
    );
    byId("filters").replaceChildren(...chips);
  }

  toggle(name, chip) {
    if (!this.filter.delete(name)) this.filter.add(name);
    chip.setAttribute("aria-pressed", String(this.filter.has(name)));
    this.shown = SHOWN;
    this.fillList();
    this.viewer.redraw();
  }

  only(name) {
    this.filter = new Set([name]);
    this.shown = SHOWN;
    this.fillFilters();
    this.fillList();
    this.viewer.redraw();
  }

  fillList() {
    const marks = this.marks;
    const items = marks.slice(0, this.shown).map((mark) => this.item(mark));
    if (marks.length > this.shown) {
      const more = () => {
        this.shown += SHOWN;
        this.fillList();
      };
      items.push(element("li", {}, element("button", { class: "more", type: "button", onclick: more }, `${marks.length - this.shown} more`)));
    }
    byId("list").replaceChildren(...items);
    byId("nothing").hidden = marks.length > 0;
    byId("nothing").textContent = page.violations.length ? "None that was claimed; what was not can be switched on above." : "None.";
  }

  item(mark) {
    return element(
      "li",
      {},
      element(
        "button",
        {
          class: `place ${mark.tone}`,
          type: "button",
          id: `place-${mark.index}`,
          "aria-current": String(mark === this.viewer.scene?.chosen),
          onclick: () => this.viewer.choose(mark.index),
        },
        element("span", { class: "kind" }, words(mark.kind)),
        element("span", { class: "tag" }, words(mark.tone)),
        element("span", { class: "of" }, words(mark.property)),
        element("span", { class: "message" }, mark.message),
      ),
    );
  }

  // Show all about a violation; null: nothing.
  show(mark) {
    for (const button of document.querySelectorAll("#list [aria-current=true]")) button.setAttribute("aria-current", "false");
    const details = byId("details");
    details.hidden = mark === null;
    if (mark === null) return;
    const button = byId(`place-${mark.index}`);
    button?.setAttribute("aria-current", "true");
    button?.scrollIntoView({ block: "nearest" });
    byId("what").replaceChildren(
      element("span", { class: "kind" }, words(mark.kind)),
      element("span", { class: `tag ${mark.tone}` }, words(mark.tone)),
      element("span", { class: "of" }, words(mark.property)),
    );
    byId("sentence").textContent = mark.message;
    const facts = [];
    const fact = (name, value) => facts.push(element("dt", {}, name), element("dd", {}, value));
    if (mark.triangles.length) fact("cells", mark.triangles.join(", "));
    if (mark.sign !== null) fact("sign", mark.sign > 0 ? "+1" : String(mark.sign));
    if (mark.magnitude !== null) {
      fact("magnitude", mark.approximately);
      fact("exactly", element("code", { tabindex: "0" }, mark.magnitude));
    }
    if (mark.degrees !== undefined) fact("degrees", String(mark.degrees));
    byId("facts").replaceChildren(...facts);
    byId("vertices").replaceChildren(...mark.points.map((point) => this.vertex(point)));
    byId("vertex-table").hidden = !mark.points.length;
  }

  vertex({ vertex, decimal, hex }) {
    const name = vertex === null ? "·" : String(vertex);
    const flies = vertex !== null && decimal !== null;
    const go = { class: "go", type: "button", title: "go nearer to this vertex", "aria-label": `go nearer to vertex ${name}`, onclick: () => this.viewer.approach(vertex) };
    return element(
      "tr",
      {},
      element("th", { scope: "row" }, flies ? element("button", go, name) : name),
      ...[0, 1].map((axis) =>
        element("td", {}, element("span", {}, decimal?.[axis] ?? "no such point"), element("span", { class: "hex" }, hex?.[axis] ?? "")),
      ),
    );
  }
}
