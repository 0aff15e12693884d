//! Kept fields of structures and variants, one definition each.

/// Lists the kept fields of a structure, and the fields left out `without` loss because the deck or the next step provides them. With `:
/// Default` lists may grow by such structures.
#[macro_export]
macro_rules! keep {
    ($type:ty { $($field:ident),* $(,)? } $(without { $($left:ident),* $(,)? })?) => {
        impl $crate::snapshot::Keep for $type {
            fn keep(&mut self, snapshot: &mut $crate::snapshot::Snapshot) {
                let Self { $($field,)* $($($left: _,)*)? } = self;
                $($crate::snapshot::Keep::keep($field, snapshot);)*
            }
        }
    };
    ($type:ident : Default { $($field:ident),* $(,)? }) => {
        impl $crate::snapshot::Keep for $type {
            fn keep(&mut self, snapshot: &mut $crate::snapshot::Snapshot) {
                let Self { $($field,)* } = self;
                $($crate::snapshot::Keep::keep($field, snapshot);)*
            }

            fn blank() -> Option<Self> {
                Some(Self::default())
            }
        }
    };
}

/// Says of variants what each of them keeps, and their numbers in a snapshot.
#[macro_export]
macro_rules! keep_either {
    ($type:ident { $($number:literal => $variant:ident $({ $($field:ident),* $(,)? })? $(($item:ident))?),* $(,)? }) => {
        impl $crate::snapshot::Keep for $type {
            fn keep(&mut self, snapshot: &mut $crate::snapshot::Snapshot) {
                let before: u8 = match self { $(Self::$variant { .. } => $number,)* };
                let mut number = before;
                $crate::snapshot::Keep::keep(&mut number, snapshot);
                if number != before {
                    let blank = || match number {
                        $($number => Some(Self::$variant
                            $({ $($field: $crate::snapshot::Keep::blank()?),* })?
                            $(({ let $item = $crate::snapshot::Keep::blank()?; $item }))?
                        ),)*
                        _ => None,
                    };
                    match blank() {
                        Some(blank) => *self = blank,
                        None => return snapshot.tear(),
                    }
                }
                match self {
                    $(Self::$variant $({ $($field),* })? $(($item))? => {
                        $($($crate::snapshot::Keep::keep($field, snapshot);)*)?
                        $($crate::snapshot::Keep::keep($item, snapshot);)?
                    })*
                }
            }

            fn blank() -> Option<Self> {
                // Whichever variant comes first is overwritten.
                let first: [fn() -> Option<Self>; _] = [$(|| Some(Self::$variant
                    $({ $($field: $crate::snapshot::Keep::blank()?),* })?
                    $(({ let $item = $crate::snapshot::Keep::blank()?; $item }))?
                )),*];
                first[0]()
            }
        }
    };
}
