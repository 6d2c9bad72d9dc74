/**
 * Bundles the viewer into two pages of `python/drystone/viewer`, `page.html` for the plane and
 * `space.html`: script and style inline, and a place where Python puts the recording. A page's
 * policy lets it load nothing else.
 */
import { createHash } from "node:crypto";
import { readFileSync, renameSync, writeFileSync } from "node:fs";
import { deflateSync } from "node:zlib";
import { build } from "esbuild";

const PAGES = new URL("../python/drystone/viewer/", import.meta.url);

async function bundled(entry: string): Promise<string> {
    const { outputFiles } = await build({
        entryPoints: [new URL(entry, import.meta.url).pathname],
        bundle: true,
        minify: true,
        write: false,
        charset: "utf8",
        format: "iife",
        target: ["chrome103", "firefox113", "safari16.4"],
        // Whose work is bundled, and under which licence, stays with it.
        legalComments: "eof",
    });
    return outputFiles[0].text.trim();
}

function fingerprint(text: string): string {
    return `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
}

function source(name: string): string {
    return readFileSync(new URL(`src/${name}`, import.meta.url), "utf8").trimEnd();
}

/** Writes a page; `runs` are all the scripts it may run, `script` is the one it has as text. */
function write(name: string, script: string, runs: string[], slots: Record<string, string>): void {
    if (/<\/script/i.test(script) || /<\/style/i.test(style)) {
        throw new Error("the bundle would end its own element");
    }
    const allowed = runs.map(fingerprint).join(" ");
    const policy = `default-src 'none'; script-src ${allowed}; style-src ${fingerprint(style)}; base-uri 'none'; form-action 'none'`;
    const parts: Record<string, string> = { ...slots, policy, style, script };
    const page = source("page.html").replace(
        /\{\{(\w+)\}\}/g,
        (slot, part: string) => parts[part] ?? slot,
    );
    const target = new URL(name, PAGES);
    const part = new URL(`${target.href}.part`);
    writeFileSync(part, `${page}\n`);
    renameSync(part, target);
}

const style = await bundled("src/page.css");

const plane = await bundled("src/main.ts");
write("page.html", plane, [plane], {
    keys: source("keys.html"),
    options: "",
    scale: "",
    packed: "",
});

const [load, space] = [await bundled("src/space/load.ts"), await bundled("src/space/main.ts")];
const data = deflateSync(space, { level: 9 }).toString("base64");
write("space.html", load, [load, space], {
    keys: source("space/keys.html"),
    options: `\n${source("space/options.html")}`,
    scale: '\n<p id="scale" hidden></p>',
    packed: `\n<script id="script" type="application/octet-stream">${data}</script>`,
});
