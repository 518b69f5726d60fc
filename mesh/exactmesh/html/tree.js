// A packed tree of boxes over things sorted along a space-filling curve; built once, a bite at a time.

const LEAF = 16;

// Spread the lower 16 bits of a number to every other bit.
function spread(x) {
  x = (x | (x << 8)) & 0x00ff00ff;
  x = (x | (x << 4)) & 0x0f0f0f0f;
  x = (x | (x << 2)) & 0x33333333;
  return (x | (x << 1)) & 0x55555555;
}

class Tree {
  // boxOf(i, box) writes west, south, east, north and returns whether thing i can be seen at all.
  static async over(count, boxOf, extent) {
    const tree = new Tree();
    const keys = new Uint32Array(count);
    const rows = new Uint32Array(count);
    const box = new Float64Array(4);
    const [west, south, east, north] = extent;
    const across = east > west ? 65535 / (east - west) : 0;
    const up = north > south ? 65535 / (north - south) : 0;
    let kept = 0;
    for (let i = 0; i < count; i++) {
      if (boxOf(i, box)) {
        const x = (box[0] / 2 + box[2] / 2 - west) * across;
        const y = (box[1] / 2 + box[3] / 2 - south) * up;
        keys[kept] = (spread(x & 0xffff) | (spread(y & 0xffff) << 1)) >>> 0;
        rows[kept++] = i;
      }
      if ((i & 4095) === 0 && late()) await breathe();
    }
    tree.rows = await sortedBy(keys.subarray(0, kept), rows.subarray(0, kept));
    await tree.fill(boxOf);
    return tree;
  }

  async fill(boxOf) {
    const box = new Float64Array(4);
    const leaves = Math.ceil(this.rows.length / LEAF);
    let boxes = new Float64Array(4 * leaves);
    for (let leaf = 0; leaf < leaves; leaf++) {
      let [west, south, east, north] = [Infinity, Infinity, -Infinity, -Infinity];
      const end = Math.min(LEAF * (leaf + 1), this.rows.length);
      for (let i = LEAF * leaf; i < end; i++) {
        boxOf(this.rows[i], box);
        if (box[0] < west) west = box[0];
        if (box[1] < south) south = box[1];
        if (box[2] > east) east = box[2];
        if (box[3] > north) north = box[3];
      }
      boxes.set([west, south, east, north], 4 * leaf);
      if ((leaf & 511) === 0 && late()) await breathe();
    }
    this.levels = [boxes];
    while (boxes.length > 4) {
      const above = new Float64Array(4 * Math.ceil(boxes.length / 4 / LEAF));
      for (let i = 0; i < boxes.length; i += 4) {
        const j = 4 * Math.floor(i / 4 / LEAF);
        const fresh = (i / 4) % LEAF === 0;
        for (const side of [0, 1]) above[j + side] = fresh ? boxes[i + side] : Math.min(above[j + side], boxes[i + side]);
        for (const side of [2, 3]) above[j + side] = fresh ? boxes[i + side] : Math.max(above[j + side], boxes[i + side]);
      }
      this.levels.push(above);
      boxes = above;
    }
  }

  // Yield [begin, end) of the rows of each leaf that meets the window; a node no larger than `speck` comes as a whole.
  *leaves(window, speck = 0) {
    if (!this.rows.length) return;
    const [west, south, east, north] = window;
    const stack = [[this.levels.length - 1, 0]];
    while (stack.length) {
      const [level, node] = stack.pop();
      const boxes = this.levels[level];
      const i = 4 * node;
      if (boxes[i] > east || boxes[i + 1] > north || boxes[i + 2] < west || boxes[i + 3] < south) continue;
      const size = LEAF ** (level + 1);
      const small = boxes[i + 2] - boxes[i] <= speck && boxes[i + 3] - boxes[i + 1] <= speck;
      if (level === 0 || small) {
        yield [node * size, Math.min((node + 1) * size, this.rows.length), small ? boxes.subarray(i, i + 4) : null];
        continue;
      }
      const below = this.levels[level - 1].length / 4;
      for (let child = Math.min((node + 1) * LEAF, below) - 1; child >= node * LEAF; child--) stack.push([level - 1, child]);
    }
  }

  // Return the rows whose boxes meet the window, or null where there are more than `most`.
  found(window, boxOf, most) {
    const rows = [];
    const box = new Float64Array(4);
    const [west, south, east, north] = window;
    for (const [begin, end] of this.leaves(window)) {
      for (let i = begin; i < end; i++) {
        boxOf(this.rows[i], box);
        if (box[0] <= east && box[1] <= north && box[2] >= west && box[3] >= south) rows.push(this.rows[i]);
      }
      if (rows.length > most) return null;
    }
    return rows;
  }
}

// Return the rows sorted by their keys: two rounds of counting.
async function sortedBy(keys, rows) {
  for (const shift of [0, 16]) {
    const first = new Uint32Array(65537);
    for (let i = 0; i < keys.length; i++) first[((keys[i] >>> shift) & 0xffff) + 1]++;
    for (let i = 0; i < 65536; i++) first[i + 1] += first[i];
    const [nextKeys, nextRows] = [new Uint32Array(keys.length), new Uint32Array(keys.length)];
    for (let i = 0; i < keys.length; i++) {
      const at = first[(keys[i] >>> shift) & 0xffff]++;
      nextKeys[at] = keys[i];
      nextRows[at] = rows[i];
      if ((i & 65535) === 0 && late()) await breathe();
    }
    [keys, rows] = [nextKeys, nextRows];
  }
  return rows;
}
