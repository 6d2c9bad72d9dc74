/**
 * Bundles the viewer into one page, `python/drystone/viewer/page.html`: script and style inline, and
 * a place where Python puts the recording. The page's policy lets it load nothing else.
 */
import { createHash } from "node:crypto";
import { readFileSync, renameSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const PAGE = new URL("../python/drystone/viewer/page.html", import.meta.url);

async function bundled(entry: string): Promise<string> {
    const { outputFiles } = await build({
        entryPoints: [new URL(entry, import.meta.url).pathname],
        bundle: true,
        minify: true,
        write: false,
        charset: "utf8",
        format: "iife",
        target: ["chrome103", "firefox113", "safari16.4"],
        legalComments: "none",
    });
    return outputFiles[0].text.trim();
}

function fingerprint(text: string): string {
    return `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
}

const script = await bundled("src/main.ts");
const style = await bundled("src/page.css");
if (/<\/script/i.test(script) || /<\/style/i.test(style)) {
    throw new Error("the bundle would end its own element");
}
const parts: Record<string, string> = {
    policy: `default-src 'none'; script-src ${fingerprint(script)}; style-src ${fingerprint(style)}; base-uri 'none'; form-action 'none'`,
    style,
    script,
};
const template = readFileSync(new URL("src/page.html", import.meta.url), "utf8");
const page = template.replace(/\{\{(policy|style|script)\}\}/g, (_, name: string) => parts[name]);
const part = new URL(`${PAGE.href}.part`);
writeFileSync(part, page);
renameSync(part, PAGE);
