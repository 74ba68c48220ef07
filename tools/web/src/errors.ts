/** A call that the library refused. Nothing was changed. */
export class LockstoneError extends Error {
  override readonly name = "LockstoneError";

  constructor(
    /** `LKS_INVALID_ARGUMENT`, … of the C interface; `Status` names the usual ones. */
    readonly status: number,
    /** Of the status, for people: "stale handle". */
    readonly statusName: string,
    /** Why, for people: "body.shape.radius: 0 m, must be 0.000977 … 512 m". */
    readonly reason: string,
  ) {
    super(reason === "" ? statusName : `${statusName}: ${reason}`);
  }
}

/** Outcomes of a call that programs ask for. */
export const Status = {
  capacityExhausted: 1,
  staleHandle: 2,
  invalidArgument: 3,
  truncated: 4,
  malformed: 5,
  checksumMismatch: 6,
  unsupportedVersion: 7,
  incompatible: 8,
  notFound: 10,
  readOnly: 67,
  outOfMemory: 68,
} as const;
