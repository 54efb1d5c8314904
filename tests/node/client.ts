/** What a client does with the types that are generated from the OpenAPI document: run with the service's address. */
import createClient from "openapi-fetch";
import type { components, paths } from "./api.js";

type Problem = components["schemas"]["JobRequest"]["problem"];

const client = createClient<paths>({ baseUrl: process.argv[2]! });

const problem: Problem = {
  kind: "motion",
  positions: [
    { x: 0, y: 0, angle: 0 },
    { x: 40, y: 15, angle: -25 },
    { x: 75, y: 5, angle: -60 },
  ],
  constraints: { min_transmission_angle: 30 },
};

/** The types refuse what the service would refuse; where one of them let it pass, the comment above it would be an error. */
export const refused: Problem[] = [
  // @ts-expect-error: there is no such kind
  { kind: "perpetual_motion" },
  // @ts-expect-error: the positions are missing
  { kind: "motion" },
  // @ts-expect-error: no such unit
  { kind: "gear_train", ratio: "pi", length_unit: "furlong" },
  // @ts-expect-error: an angle is a number
  { kind: "motion", positions: [{ x: 0, y: 0, angle: "steep" }] },
];

async function solved() {
  const { data, error } = await client.POST("/v1/jobs", {
    params: { header: { prefer: "wait=30", "idempotency-key": "from-the-generated-client" } },
    body: { problem, label: "generated" },
  });
  if (error) throw new Error(error.detail);
  return data;
}

const job = await solved();
if (job.result === null || job.problem.kind !== "motion") throw new Error(`the job is ${job.status}`);

const path = { job_id: job.id, number: "0" };
const drawing = await client.GET("/v1/jobs/{job_id}/designs/{number}.svg", { params: { path }, parseAs: "text" });
const moved = await client.GET("/v1/jobs/{job_id}/designs/{number}/motion", {
  params: { path, query: { steps: 36 } },
});
const listed = await client.GET("/v1/jobs", { params: { query: { kind: "motion", status: "succeeded", limit: 5 } } });
const wrong = await client.POST("/v1/jobs", {
  body: { problem: { ...problem, positions: [{ x: 0, y: 0, angle: 0 }] } },
});
const kinds = await client.GET("/v1/problems");

console.log(
  JSON.stringify({
    status: job.status,
    label: job.label,
    positions: job.problem.positions.length,
    designs: job.result.designs.length,
    complete: job.result.search.complete,
    drawn: drawing.data?.includes("<svg"),
    moved: moved.data !== undefined,
    listed: listed.data?.jobs.map((one) => one.id).includes(job.id),
    kinds: kinds.data?.problems.map((kind) => kind.kind),
    refusal: wrong.error?.errors?.map((fault) => fault.path),
    refused_with: wrong.response.status,
  }),
);
