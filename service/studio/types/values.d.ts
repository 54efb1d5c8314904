/** What the page knows of the service's values, by short names; `make types` makes ./api.d.ts from the code. */

import type { components } from "./api.js";

export type Schemas = components["schemas"];

/** What JSON can say: of a statement that is walked by its schema no more is known before the page runs. */
export type Json = string | number | boolean | null | Json[] | { [name: string]: Json | undefined };

type Names<Union> = Union extends unknown ? keyof Union : never;
type At<Union, Name> = Union extends unknown ? (Name extends keyof Union ? Union[Name] : never) : never;
type Always<Union, Name extends keyof Union = keyof Union> = Name extends unknown
  ? undefined extends Union[Name]
    ? never
    : Name
  : never;

/** What of a type is an object with fields, and what is a list of such. */
type Group<Value> = Value extends object ? (Value extends readonly unknown[] ? never : Value) : never;
type Item<Value> = Value extends readonly (infer One)[] ? ([Group<One>] extends [never] ? never : One) : never;
type Rest<Value> = Value extends object
  ? Value extends readonly (infer One)[]
    ? [Group<One>] extends [never]
      ? Value
      : never
    : never
  : Value;

/** Where all of several have a field it is there, and it may be there where one has it. */
type Fields<Union> = { [Name in Always<Union>]: Merged<Union[Name]> } & {
  [Name in Exclude<Names<Union>, Always<Union>>]?: Merged<At<Union, Name>>;
};

/** One of several, of which it is not known which, with the fields of all; so are the values of its fields. */
export type Merged<Value> =
  | Rest<Value>
  | ([Item<Value>] extends [never] ? never : Merged<Item<Value>>[])
  | ([Group<Value>] extends [never] ? never : Fields<Group<Value>>);

/** A statement: of whatever kind, and perhaps not complete. */
export type Problem = Merged<Schemas["JobRequest"]["problem"]>;
export type Result = Merged<NonNullable<Schemas["Job"]["result"]>>;
export type Job = Omit<Schemas["Job"], "problem" | "result"> & { problem: Problem; result: Result | null };
export type Solved = Job & { result: Result };
export type Design = Result["designs"][number];
export type Mechanism = Design["mechanism"];
export type Skeleton = Schemas["Skeleton"];
export type LinkageAnalysis = Schemas["LinkageAnalysis"];
export type Analysis = Schemas["Analysis"];
export type TrainMotion = Schemas[
  "GearTrainAnalysis" | "PlanetaryAnalysis" | "TrainSeriesAnalysis" | "GearboxAnalysis"];
export type Question = Omit<Schemas["LinkageAnalysisRequest"], "mechanism"> & { mechanism: Mechanism };

/** One mechanism, which its type tells from the others. */
export type OneMechanism = NonNullable<Schemas["Job"]["result"]>["designs"][number]["mechanism"];
export type Metrics = Design["metrics"];

/** A linkage, and what is known of it: of a cognate that is less than of a design. */
export type Linked = Mechanism & { skeleton: Skeleton };
export type LinkedDesign = Partial<Omit<Design, "mechanism">> & { mechanism: Linked };
export type Layout = NonNullable<Design["layout"]>;

/** What shows one type of mechanism takes the designs and the motions of that type only, which is its name's affair. */
export declare class MovingView {
  constructor(frame: import("../canvas/stage.js").Frame, design: Design, motion: Analysis, problem: Problem);
  stop(): void;
  pause?(): void;
  player: import("../core/player.js").Player;
}
