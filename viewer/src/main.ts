/** The page of a recording in the plane. */
import { PlaneStage } from "./plane.ts";
import { start } from "./start.ts";

void start((film, canvas) => new PlaneStage(film, canvas));
