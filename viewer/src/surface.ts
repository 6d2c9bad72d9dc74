/** A canvas that has the device's pixels and is drawn on in the page's. */

export class Surface {
    readonly canvas: HTMLCanvasElement;
    readonly context: CanvasRenderingContext2D;
    width = 0;
    height = 0;

    constructor(canvas: HTMLCanvasElement) {
        const context = canvas.getContext("2d");
        if (!context) throw new Error("This browser cannot draw on a canvas.");
        this.canvas = canvas;
        this.context = context;
    }

    /** Takes the size the canvas has on the page; true if that changed. */
    resize(): boolean {
        const { clientWidth, clientHeight } = this.canvas;
        const ratio = globalThis.devicePixelRatio || 1;
        const [w, h] = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
        if (this.canvas.width === w && this.canvas.height === h && this.width > 0) return false;
        this.canvas.width = w;
        this.canvas.height = h;
        this.width = clientWidth;
        this.height = clientHeight;
        this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
        return true;
    }

    clear(colour: string): void {
        this.context.fillStyle = colour;
        this.context.fillRect(0, 0, this.width, this.height);
    }
}
