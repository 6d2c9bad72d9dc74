/**
 * Runs the page's script, which is deflated here: the library that draws in space is most of it.
 * The page's policy names the script's fingerprint, and lets no other one run.
 */
async function load(): Promise<void> {
    const packed = document.getElementById("script")?.textContent ?? "";
    const bytes = Uint8Array.from(atob(packed.trim()), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    const script = document.createElement("script");
    script.textContent = await new Response(stream).text();
    document.body.append(script);
}

void load();
