/** The page of a recording in space. */
import { start } from "../start.ts";
import { SpaceStage } from "./stage.ts";

void start((film, canvas) => new SpaceStage(film, canvas));
